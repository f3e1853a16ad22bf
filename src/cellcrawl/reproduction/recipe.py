"""What a recipe is: the name of a figure or movie of the paper, and how it is made."""

from __future__ import annotations

import hashlib
import importlib
import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cellcrawl.reproduction.workspace import Workspace


@dataclass(frozen=True)
class Recipe:
    """A figure or movie of the paper; immutable.

    Parameters
    ----------
    name : str
        What the user asks for.
    title : str
        What it shows.
    needs : str
        What is computed for it.
    seconds : float
        About how long that takes on one core, with what others share still to be made.
    module : str
        The module of this package whose function ``make(workspace, name)`` makes it and returns
        what was found, a line each.
    """

    name: str
    title: str
    needs: str
    seconds: float
    module: str

    def make(self, workspace: Workspace) -> list[str]:
        """Make everything; return what was found, a line each."""
        make: Callable[[Workspace, str], list[str]] = self._module().make
        return make(workspace, self.name)

    def identity(self, *choices: Any) -> str:
        """Return a hash of these choices, of the recipe and of the code that decides results."""
        from cellcrawl.sweeps.identity import code_version

        recipe = Path(str(self._module().__file__)).read_text("utf-8")
        content = json.dumps([self.name, recipe, code_version(), *choices])
        return hashlib.sha256(content.encode()).hexdigest()[:32]

    def _module(self) -> Any:
        return importlib.import_module(f"cellcrawl.reproduction.{self.module}")
