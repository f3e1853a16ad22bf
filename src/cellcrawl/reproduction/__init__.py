"""The figures and movies of the paper, each by name, with the data behind them."""

from cellcrawl.reproduction.recipe import Recipe
from cellcrawl.reproduction.registry import GROUPS, RECIPES
from cellcrawl.reproduction.reproduce import Made, reproduce

__all__ = ["GROUPS", "RECIPES", "Made", "Recipe", "reproduce"]
