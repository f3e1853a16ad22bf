"""The runs of a sweep: every combination of values along axes, a list of points, or both."""

from __future__ import annotations

import dataclasses
import hashlib
import itertools
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws.law import PAPER
from cellcrawl.parameters import CONSTANT, Parameters, Schedule
from cellcrawl.parameters.named import read_toml
from cellcrawl.simulation.description import DEFAULT_SOLVER, RunDescription
from cellcrawl.simulation.start_tables import start_from_table
from cellcrawl.starts import RandomPerturbation, Start
from cellcrawl.sweeps.axes import (
    NAMES,
    OPTIONS,
    PARAMETERS,
    SETTINGS,
    WORLD,
    axis_values,
    plain,
    value_of,
)
from cellcrawl.sweeps.identity import start_identity
from cellcrawl.validation import known_names, shown, table, whole_number

_TABLES = ("parameters", "axes", "points", "start", "schedule", "run")
_RUN = (*SETTINGS, *WORLD, *OPTIONS)


@checked
@dataclass(frozen=True, kw_only=True)
class Grid:
    """Runs to be made, described by what differs and what they share; immutable.

    Parameters
    ----------
    axes : mapping of str to sequence
        Values of parameters, ``seed``, ``start``, ``schedule``, ``t_end``, ``save_every``,
        ``solver``, ``nodes`` or solver options. Every combination is a run; the last axis runs
        fastest. A range may be given as ``{"from": 10, "to": 60, "step": 2}``.
    points : sequence of mapping
        Combinations given one by one, of the same names. With axes, each point is combined with
        all values of the axes.
    parameters : Parameters
        Values of what no axis or point names.
    start, schedule, t_end, save_every, solver, nodes, options
        As in `simulate`.

    Raises
    ------
    InputError
        For no axes and no points, an unknown name, an empty axis, a value out of range, or a name
        that is both an axis and in a point.

    Examples
    --------
    >>> grid = Grid(axes={"r_on": [20, 30], "zeta_1": [500, 600], "seed": [1, 2, 3]})
    >>> len(grid), grid.run(5).parameters.zeta_1, grid.run(5).start.seed
    (12, 600.0, 3)
    """

    axes: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    points: Sequence[Mapping[str, Any]] = ()
    parameters: Parameters = dataclasses.field(default_factory=Parameters)
    start: Start = dataclasses.field(default_factory=RandomPerturbation)
    schedule: Schedule = CONSTANT
    t_end: float = 100.0
    save_every: float = 0.1
    solver: str = DEFAULT_SOLVER
    nodes: int | None = None
    laws: Any = PAPER
    surroundings: Any = None
    options: Mapping[str, Any] = dataclasses.field(default_factory=dict)

    def __post_init__(self) -> None:
        axes = {n: axis_values(n, values) for n, values in table("axes", self.axes).items()}
        points = tuple(_checked_point(point, axes) for point in self.points)
        if not axes and not any(points):
            raise InputError(
                "the grid is empty: give axes, as in {'r_on': [20, 30]}, or points; simulate makes "
                "a single run"
            )
        object.__setattr__(self, "axes", axes)
        object.__setattr__(self, "points", points)
        self._check()

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of points (if there are any), then of values along each axis."""
        sizes = tuple(len(values) for values in self.axes.values())
        return (len(self.points), *sizes) if self.points else sizes

    def __len__(self) -> int:
        return math.prod(self.shape)

    @checked
    def run(self, index: int) -> RunDescription:
        """Return the run at an index, 0 to ``len(grid) - 1``."""
        whole_number("index", index, 0, len(self) - 1)
        changes: dict[str, Any] = {}
        for name in reversed(tuple(self.axes)):
            index, place = divmod(index, len(self.axes[name]))
            changes[name] = self.axes[name][place]
        return self._described({**(self.points[index] if self.points else {}), **changes})

    def __iter__(self) -> Iterator[RunDescription]:
        for point in self.points or ({},):
            for values in itertools.product(*self.axes.values()):
                yield self._described({**point, **dict(zip(self.axes, values, strict=True))})

    def describe(self) -> dict[str, Any]:
        """Return the grid as plain values for JSON; `from_dict` takes them back."""
        usual = RunDescription(
            parameters=self.parameters,
            start=self.start,
            schedule=self.schedule,
            t_end=self.t_end,
            save_every=self.save_every,
            solver=self.solver,
            nodes=self.nodes,
            laws=self.laws,
            surroundings=self.surroundings,
            options=self.options,
        ).describe()
        world = {name: usual[name] for name in WORLD if name in usual}
        return {
            "parameters": usual["parameters"],
            "axes": {name: [plain(v) for v in values] for name, values in self.axes.items()},
            "points": [{n: plain(v) for n, v in point.items()} for point in self.points],
            "start": usual["start"],
            "schedule": usual["schedule"],
            "run": {**{name: usual[name] for name in SETTINGS}, **world, **usual["options"]},
        }

    @property
    def digest(self) -> str:
        """A hash of the grid's content."""
        starts = [self.start, *self.axes.get("start", ())]
        starts += [point["start"] for point in self.points if "start" in point]
        content = [self.describe(), [start_identity(start) for start in starts]]
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:32]

    def summary(self) -> str:
        """Return the grid in a few words, as in ``r_on 26 x zeta_1 11 x seed 5``."""
        words = [f"{len(self.points)} points"] if self.points else []
        words += [f"{name} {len(values)}" for name, values in self.axes.items()]
        return " x ".join(words)

    def replace(self, /, **changes: Any) -> Grid:
        """Return a copy with some fields changed."""
        return dataclasses.replace(self, **changes)

    @classmethod
    def from_dict(cls, content: Mapping[str, Any], **settings: Any) -> Grid:
        """Build from tables ``parameters, axes, points, start, schedule, run``, or plain axes.

        Parameters
        ----------
        content : mapping
            Either those tables, or names with their values: ``{"r_on": [20, 30], "seed": [1, 2]}``.
        **settings
            Fields of the grid that win over the content.
        """
        content = table("the grid", content)
        if not any(name in content for name in ("axes", "points", "parameters", "run")):
            return cls(axes=content, **settings)
        known_names("the grid file", content, _TABLES)
        run = dict(table("[run]", content.get("run", {})))
        known_names("[run]", run, _RUN)
        fields: dict[str, Any] = {
            "axes": table("[axes]", content.get("axes", {})),
            "points": content.get("points", ()),
            "parameters": Parameters.from_dict(content.get("parameters", {})),
            "options": {name: run.pop(name) for name in OPTIONS if name in run},
            **run,
        }
        if "start" in content:
            fields["start"] = start_from_table(content["start"])
        if "schedule" in content:
            fields["schedule"] = Schedule(content["schedule"])
        return cls(**{**fields, **settings})

    @classmethod
    def from_toml(cls, source: str | Path, **settings: Any) -> Grid:
        """Read from a TOML file or text with the tables of `from_dict`."""
        content = read_toml(source)
        known_names(
            f"the grid file {source}" if "\n" not in str(source) else "it", content, _TABLES
        )
        if not content.get("axes") and not content.get("points"):
            raise InputError("a grid file needs [axes], such as r_on = [20, 30], or [[points]]")
        return cls.from_dict({"run": {}, **content}, **settings)

    def _described(self, changes: Mapping[str, Any]) -> RunDescription:
        rest = dict(changes)
        start = rest.pop("start", self.start)
        if "seed" in rest:
            start = _seeded(start, rest.pop("seed"))
        own = {name: rest.pop(name) for name in PARAMETERS if name in rest}
        options = {**self.options, **{name: rest.pop(name) for name in OPTIONS if name in rest}}
        shared = {name: getattr(self, name) for name in ("schedule", *WORLD, *SETTINGS)}
        return RunDescription(
            parameters=self.parameters.replace(**own) if own else self.parameters,
            start=start,
            options=options,
            **{**shared, **rest},
        )

    def _check(self) -> None:
        """Make each value of each axis and each point once, so that mistakes show at once."""
        first = {name: values[0] for name, values in self.axes.items()}
        for point in self.points or ({},):
            self._described({**point, **first})
        for name, values in self.axes.items():
            for value in values:
                self._described({**(self.points[0] if self.points else {}), **first, name: value})


def as_grid(grid: Any, **settings: Any) -> Grid:
    """Return a grid from a `Grid`, a mapping, a list of points or the path of a TOML file."""
    if isinstance(grid, Grid):
        return grid.replace(**settings) if settings else grid
    known_names("sweep", settings, [field.name for field in dataclasses.fields(Grid)])
    if isinstance(grid, Mapping):
        return Grid.from_dict(grid, **settings)
    if isinstance(grid, (str, Path)):
        return Grid.from_toml(Path(grid), **settings)
    if isinstance(grid, Sequence):
        return Grid(points=grid, **settings)
    raise InputError(
        f"a grid is a table of names and values, a list of points or a TOML file, not {shown(grid)}"
    )


def united(grids: Sequence[Grid]) -> Grid:
    """Return one grid with the runs of several.

    Where they share all but the values of the same axes it has those axes with all values, and so
    may have runs that none of them has; otherwise its points are their runs.
    """
    first, *others = grids
    if not others:
        return first
    shared = [{n: v for n, v in g.describe().items() if n not in ("axes", "points")} for g in grids]
    alike = all(settings == shared[0] for settings in shared)
    if alike and all(set(g.axes) == set(first.axes) and not g.points for g in grids):
        axes = {
            name: list({repr(value): value for g in grids for value in g.axes[name]}.values())
            for name in first.axes
        }
        return first.replace(axes=axes)
    points: dict[str, dict[str, Any]] = {}
    for grid in grids:
        own = {} if alike else _own_settings(grid)
        for point in grid.points or ({},):
            for values in itertools.product(*grid.axes.values()):
                combined = {**own, **point, **dict(zip(grid.axes, values, strict=True))}
                points.setdefault(repr(combined), combined)
    return first.replace(axes={}, points=list(points.values()))


def _own_settings(grid: Grid) -> dict[str, Any]:
    """Return what a grid's runs share, as values of a point."""
    settings = {name: getattr(grid, name) for name in ("start", "schedule", *WORLD, *SETTINGS)}
    settings = {name: value for name, value in settings.items() if value is not None}
    return {**grid.parameters.to_dict(), **settings, **grid.options}


def _checked_point(point: Any, axes: Mapping[str, Any]) -> dict[str, Any]:
    values = table("a point of the grid", point)
    known_names("a point of the grid", values, NAMES)
    for name in values:
        if name in axes:
            raise InputError(f"{name} is both an axis and in a point of the grid: give it once")
    return {str(name): value_of(name, value) for name, value in values.items()}


def _seeded(start: Start, seed: int) -> Start:
    if not isinstance(start, RandomPerturbation):
        raise InputError(
            f"seed is for a random start, not for {type(start).__name__}: leave the seeds out"
        )
    return dataclasses.replace(start, seed=seed)
