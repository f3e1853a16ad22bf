"""The words of a link as a run of the package, and a run's parameters as a link."""

from __future__ import annotations

from typing import Any, Final, NamedTuple
from urllib.parse import parse_qsl

from cellcrawl.errors import InputError
from cellcrawl.laws import PAPER, SHIPPED, Law
from cellcrawl.parameters import Parameters, Schedule
from cellcrawl.starts import RandomPerturbation
from cellcrawl.surroundings import Islands, LocalPulse, Pillars, Surrounding
from cellcrawl.validation import one_of

VERSION: Final = 2  # laws, ramps and times of discs came with 2; links without are written as 1
PULSES: Final[dict[str, dict[str, float]]] = {
    "release": {"radius": 0.5, "duration": 0.5, "binding": 0.0},
    "push": {"radius": 0.5, "duration": 0.5, "push": 1500.0},
}
"""What the page's two pokes are."""
_OF_LAWS: Final = "laws."
_FOR_EVER: Final = 1e12


class Linked(NamedTuple):
    """What a link says of a run, as `cellcrawl.simulate` takes it."""

    parameters: Parameters
    seed: int
    schedule: Schedule | None
    surroundings: list[Surrounding]
    rtol: float
    laws: Law = PAPER

    def options(self) -> dict[str, Any]:
        """Return the options of `simulate`."""
        return {
            "start": RandomPerturbation(seed=self.seed),
            "schedule": self.schedule,
            "surroundings": self.surroundings or None,
            "rtol": self.rtol,
            "laws": self.laws,
        }


def read(link: str) -> Linked:
    """Return the run of a link of the page, from its address or its fragment alone.

    Raises
    ------
    InputError
        For a link that does not say a run.
    """
    words = dict(parse_qsl(link.rpartition("#")[2], keep_blank_values=True))
    try:
        if int(words.get("v", VERSION)) > VERSION:
            raise InputError(f"the link is of version {words['v']}: this package knows {VERSION}")
        names = [name for name in Parameters.field_names() if name in words]
        given: dict[str, Any] = {
            name: words[name] if name == "elasticity" else float(words[name]) for name in names
        }
        parameters, laws = Parameters(**given), _laws(words)
        kinds = {"islands": Islands, "pillars": Pillars}
        around: list[Surrounding] = [
            kind(_discs(words[name])) for name, kind in kinds.items() if words.get(name)
        ]
        for poke in filter(None, words.get("pokes", "").split(";")):
            name, *place = poke.split(",")
            at, x, y = map(float, place)
            around.append(LocalPulse(x=x, y=y, begin=at, **PULSES[name]))
        schedule = _schedule(parameters, laws, words.get("changes", ""))
        seed, rtol = int(words.get("seed", 1)), float(words.get("rtol", 1e-4))
    except (ValueError, KeyError, TypeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"this is no link of the page: {error}") from None
    return Linked(parameters, seed, schedule, around, rtol, laws)


def _laws(words: dict[str, str]) -> Law:
    kind = SHIPPED[one_of("law", words.get("law", "paper"), SHIPPED)]
    numbers = {
        name.removeprefix(_OF_LAWS): float(value)
        for name, value in words.items()
        if name.startswith(_OF_LAWS)
    }
    return kind(**numbers)


def _discs(text: str) -> list[list[float]]:
    rows = [[float(value) for value in disc.split(",")] for disc in text.split(";") if disc]
    if all(len(row) == 3 for row in rows):
        return rows
    ends = [-_FOR_EVER, _FOR_EVER]
    return [row + ends[len(row) - 3 :] if len(row) >= 3 else row for row in rows]


def _schedule(parameters: Parameters, laws: Law, text: str) -> Schedule | None:
    points: dict[str, list[tuple[float, float]]] = {}
    now = {name: getattr(parameters, name) for name in Parameters.field_names()}
    now |= {_OF_LAWS + name: value for name, value in laws.values.items()}
    for change in filter(None, text.split(";")):
        times, *sets = change.split(",")
        begin, _, end = times.partition("~")
        for one in sets:
            name, _, value = one.partition(":")
            points.setdefault(name, []).extend(
                [(float(begin), now[name]), (float(end or begin), float(value))]
            )
            now[name] = float(value)
    return Schedule(points) if points else None


def write(parameters: Parameters, seed: int = 1, laws: Law = PAPER, **view: str) -> str:
    """Return the fragment of a link to a run with these parameters.

    Raises
    ------
    InputError
        For a law set that the page does not hold.
    """
    usual = Parameters()
    words = [f"v={1 if laws == PAPER else VERSION}"]
    for name in Parameters.field_names():
        value = getattr(parameters, name)
        if value != getattr(usual, name) or name in ("r_on", "zeta_1"):
            words.append(f"{name}={value if isinstance(value, str) else repr(float(value))}")
    if laws != PAPER:
        known = {kind: name for name, kind in SHIPPED.items()}
        if type(laws) not in known:
            raise InputError(
                f"the page holds the laws {', '.join(SHIPPED)}, and not {laws.name}: it cannot "
                "compile others"
            )
        words.append(f"law={known[type(laws)]}")
        words += [f"{_OF_LAWS}{name}={value!r}" for name, value in laws.values.items()]
    words.append(f"seed={seed}")
    words += [f"{name}={value}" for name, value in view.items()]
    return "&".join(words)
