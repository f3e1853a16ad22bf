"""The words of a link as a run of the package, and a run's parameters as a link."""

from __future__ import annotations

from typing import Any, Final, NamedTuple
from urllib.parse import parse_qsl

from cellcrawl.errors import InputError
from cellcrawl.parameters import Parameters, Schedule
from cellcrawl.starts import RandomPerturbation
from cellcrawl.surroundings import Islands, LocalPulse, Pillars, Surrounding

VERSION: Final = 1
PULSES: Final[dict[str, dict[str, float]]] = {
    "release": {"radius": 0.5, "duration": 0.5, "binding": 0.0},
    "push": {"radius": 0.5, "duration": 0.5, "push": 1500.0},
}
"""What the page's two pokes are."""


class Linked(NamedTuple):
    """What a link says of a run, as `cellcrawl.simulate` takes it."""

    parameters: Parameters
    seed: int
    schedule: Schedule | None
    surroundings: list[Surrounding]
    rtol: float

    def options(self) -> dict[str, Any]:
        """Return the options of `simulate`."""
        return {
            "start": RandomPerturbation(seed=self.seed),
            "schedule": self.schedule,
            "surroundings": self.surroundings or None,
            "rtol": self.rtol,
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
        parameters = Parameters(**given)
        discs = {
            kind: [
                [float(value) for value in disc.split(",")]
                for disc in filter(None, words.get(kind, "").split(";"))
            ]
            for kind in ("islands", "pillars")
        }
        around: list[Surrounding] = []
        if discs["islands"]:
            around.append(Islands(discs["islands"]))
        if discs["pillars"]:
            around.append(Pillars(discs["pillars"]))
        for poke in filter(None, words.get("pokes", "").split(";")):
            kind, *place = poke.split(",")
            at, x, y = map(float, place)
            around.append(LocalPulse(x=x, y=y, begin=at, **PULSES[kind]))
        schedule = _schedule(parameters, words.get("changes", ""))
        seed, rtol = int(words.get("seed", 1)), float(words.get("rtol", 1e-4))
    except (ValueError, KeyError, TypeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"this is no link of the page: {error}") from None
    return Linked(parameters, seed, schedule, around, rtol)


def _schedule(parameters: Parameters, text: str) -> Schedule | None:
    points: dict[str, list[tuple[float, float]]] = {}
    now = {name: getattr(parameters, name) for name in Parameters.field_names()}
    for change in filter(None, text.split(";")):
        at, *sets = change.split(",")
        for one in sets:
            name, _, value = one.partition(":")
            points.setdefault(name, []).extend([(float(at), now[name]), (float(at), float(value))])
            now[name] = float(value)
    return Schedule(points) if points else None


def write(parameters: Parameters, seed: int = 1, **view: str) -> str:
    """Return the fragment of a link to a run with these parameters."""
    usual = Parameters()
    words = [f"v={VERSION}"]
    for name in Parameters.field_names():
        value = getattr(parameters, name)
        if value != getattr(usual, name) or name in ("r_on", "zeta_1"):
            words.append(f"{name}={value if isinstance(value, str) else repr(float(value))}")
    words.append(f"seed={seed}")
    words += [f"{name}={value}" for name, value in view.items()]
    return "&".join(words)
