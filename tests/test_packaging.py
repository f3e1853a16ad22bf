"""The recipes ask for what pyproject.toml asks for, and run commands that exist."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

from cellcrawl.command_line.main import commands

ROOT = Path(__file__).parent.parent
RECIPE, CONTAINER = ROOT / "packaging/conda/recipe.yaml", ROOT / "packaging/Containerfile"
CONDA = {"matplotlib": "matplotlib-base"}  # without the window toolkits
pytestmark = pytest.mark.skipif(not RECIPE.exists(), reason="only in a checkout")


@pytest.fixture(scope="module")
def project():
    return tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]


def test_the_conda_recipe_has_the_dependencies_and_the_version_of_the_package(project):
    recipe = RECIPE.read_text("utf-8")
    assert f'version: "{project["version"]}"' in recipe
    run = recipe.partition("  run:\n")[2].partition("\n\n")[0]
    asked = dict(re.findall(r"^ +- ([\w-]+) (\S+)$", run, re.MULTILINE))
    assert asked.pop("python") == project["requires-python"]
    needed = dict(re.fullmatch(r"([\w-]+)(.*)", line).groups() for line in project["dependencies"])
    assert asked == {CONDA.get(name, name): bound for name, bound in needed.items()}
    (name, home), *_ = project["scripts"].items()
    assert f"{name} = {home}" in recipe


def test_extras_and_commands_of_the_recipes_exist(project):
    container = CONTAINER.read_text("utf-8")
    [extras] = re.findall(r"\.whl\)\[([\w,]+)\]", container)
    assert set(extras.split(",")) <= set(project["optional-dependencies"])
    lines = RECIPE.read_text("utf-8") + container
    for command in re.findall(r"cellcrawl (simulate|info)\b([^|&\\\n]*)", lines):
        name, rest = command
        options = set(re.findall(r"--[\w-]+", rest))
        told = CliRunner().invoke(commands, [name, "--help"]).output
        assert all(option in told for option in options), command
