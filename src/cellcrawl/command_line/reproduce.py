"""`cellcrawl reproduce`: the figures and movies of the paper."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellcrawl.command_line.main import CANCELLED
from cellcrawl.command_line.options import say, wants_progress

if TYPE_CHECKING:
    from cellcrawl import reproduction


@click.command()
@click.argument("names", nargs=-1, metavar="[NAME]...")
@click.option("--list", "listed", is_flag=True, help="Say what there is, and stop.")
@click.option(
    "--output",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Folder for the results.  [default: reproduction, or reproduction-quick]",
)
@click.option(
    "--format",
    "formats",
    default="png",
    show_default=True,
    metavar="FORMATS",
    help="Of the pictures: png, pdf, svg, or several with commas.",
)
@click.option(
    "--dpi",
    type=click.IntRange(30, 1200),
    default=200,
    show_default=True,
    help="Resolution of a .png.",
)
@click.option("--quick", is_flag=True, help="Shorter runs and fewer points: a look at how it goes.")
@click.option("--again", is_flag=True, help="Make pictures and movies anew; runs are reused.")
def reproduce(
    names: tuple[str, ...],
    listed: bool,
    output: Path | None,
    formats: str,
    dpi: int,
    quick: bool,
    again: bool,
) -> int:
    """Make figures and movies of the paper, with the data behind them.

    NAME is fig2 to fig7, movie-s1 to movie-s12, short-time, or one of the groups figures, movies
    and all. Each has its folder in DIR, and the runs that they share are in DIR/runs. What is there
    already is not made again, so a stopped command can be given once more and goes on.

    \b
    Examples
      cellcrawl reproduce --list
      cellcrawl reproduce fig3
      cellcrawl reproduce fig4 fig7 --format png,pdf
      cellcrawl reproduce all --output paper
    """
    import cellcrawl.reproduction as reproduction

    if listed or not names:
        _say_list(reproduction.RECIPES)
        return 0
    root = output or Path("reproduction-quick" if quick else "reproduction")
    chosen = [suffix.strip() for suffix in formats.split(",") if suffix.strip()]
    made = reproduction.reproduce(
        names,
        root,
        quick=quick,
        formats=chosen,
        dpi=dpi,
        again=again,
        progress=wants_progress(),
    )
    try:
        for done in made:
            _say_made(done, root)
    except KeyboardInterrupt:
        say("stopped: give the same command again and it goes on")
        return CANCELLED
    return 0


def _say_list(recipes: dict[str, reproduction.Recipe]) -> None:
    say(f"{'name':<11} {'about':>6}  what")
    for recipe in recipes.values():
        say(f"{recipe.name:<11} {recipe.seconds:>4.0f} s  {recipe.title} ({recipe.needs})")
    say("groups      figures, movies, all")


def _say_made(done: reproduction.Made, root: Path) -> None:
    took = "was there" if done.reused else f"{done.seconds:.1f} s"
    say(f"{done.recipe.name:<11} {done.recipe.title}  [{took}]")
    for line in done.found:
        say(f"  found     {line}")
    own = [
        path
        for path in done.files
        if path.parent.name == done.recipe.name and path.suffix != ".json"
    ]
    for path in own:
        what = {".mp4": "movie", ".nc": "data", ".csv": "data", ".parquet": "data"}
        say(f"  {what.get(path.suffix, 'picture'):<9} {path}")
    shared = len([path for path in done.files if path.parent == root / "runs"])
    if shared:
        say(f"  data      {shared} run{'s' if shared > 1 else ''} in {root / 'runs'}")
