"""All that makes one run, as a frozen value."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError, nearest_name
from cellcrawl.laws import as_law
from cellcrawl.laws.law import PAPER
from cellcrawl.laws.rest import CellAtRest, rest_state
from cellcrawl.parameters import CONSTANT, DESCRIPTIONS, Parameters, Schedule
from cellcrawl.simulation.dataset import SCHEMA_VERSION, package_version
from cellcrawl.simulation.events import crossing_at
from cellcrawl.simulation.explaining import check_start
from cellcrawl.simulation.following import check_records
from cellcrawl.solvers import SOLVERS, Solver
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.starts import Eigenmode, FromOutline, PerturbedCircle, RandomPerturbation, Start
from cellcrawl.surroundings import as_surroundings
from cellcrawl.validation import one_of, real_number, shown, table

DEFAULT_SOLVER = "adaptive"
_MOST_STEPS = 1e10
_PARAMETERS = (*DESCRIPTIONS, "elasticity")
_STARTS = (RandomPerturbation, Eigenmode, PerturbedCircle, FromOutline)


@checked
@dataclass(frozen=True, kw_only=True)
class RunDescription:
    """One run: parameters, start, schedule, times and solver; immutable.

    Parameters
    ----------
    parameters, t_end, start, save_every, solver, nodes, schedule, laws, surroundings
        As in `simulate`; None stands for what is usual.
    options : mapping
        The solver's own options.

    Raises
    ------
    InputError
        For a value that cannot be used. Whether the start suits the parameters, and the options
        the solver, shows when `solver_at_start` is called.
    """

    parameters: Parameters = field(default_factory=Parameters)
    t_end: float = 100.0
    start: Start = field(default_factory=RandomPerturbation)
    save_every: float = 0.1
    solver: str = DEFAULT_SOLVER
    nodes: int | None = None
    schedule: Schedule = CONSTANT
    laws: Any = PAPER
    surroundings: Any = None
    options: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        scheme = solver_named(self.solver)
        checked: dict[str, Any] = {
            "t_end": real_number("t_end", self.t_end, 0.0, 1e9),
            "save_every": real_number("save_every", self.save_every, 0.0, 1e9, open_low=True),
            "nodes": scheme.checked_nodes(self.nodes),
        }
        checked |= {
            "laws": as_law(self.laws),
            "surroundings": as_surroundings(self.surroundings),
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)
        _check_options(scheme, table("options", self.options))
        check_records(self.t_end, self.save_every)
        self.conditions.check()
        if self.options.get("dt") is not None:
            _check_steps(self.t_end, self.options["dt"])

    @property
    def conditions(self) -> Conditions:
        """The parameters and how they change."""
        return Conditions(self.parameters, self.schedule, self.laws, self.surroundings)

    def solver_at_start(self) -> Solver:
        """Return the solver with the first state, or raise `InputError` if it cannot be had."""
        scheme, conditions = solver_named(self.solver), self.conditions
        assert self.nodes is not None
        nodes = scheme.start_nodes(self.nodes, **self.options)
        state = self.start.state(self._resting(conditions.at(0.0)), nodes)
        check_start(conditions, state)
        engine = scheme(state, conditions, nodes=self.nodes, **self.options)
        if crossing_at(engine, 0.0) is not None:
            raise InputError("the start crosses itself: the model needs a simple edge")
        return engine

    def _resting(self, parameters: Parameters) -> Parameters:
        """Return parameters with the resting circle of this run's law."""
        if self.laws == PAPER:
            return parameters
        if isinstance(self.start, Eigenmode):
            raise InputError("Eigenmode knows the paper's laws only: give another start")
        laws = self.conditions.laws_at(0.0)
        return CellAtRest.of(parameters, rest_state(parameters, laws))

    def _world(self) -> dict[str, Any]:
        """Return laws and surroundings as plain values, where they are not the paper's."""
        world: dict[str, Any] = {}
        if self.laws != PAPER:
            world["laws"] = self.laws.describe()
        if self.surroundings is not None:
            world["surroundings"] = self.surroundings.describe()
        return world

    def identity(self, engine: Solver) -> dict[str, Any]:
        """Return what a saved run says of how it was made."""
        return {
            "parameters": self.parameters.to_dict(),
            "schedule": self.schedule.to_dict(),
            "start": self.start.describe(),
            "seed": getattr(self.start, "seed", -1),
            "solver": engine.name,
            "solver_options": engine.options(),
            "save_every": self.save_every,
            "cellcrawl_version": package_version(),
            "schema_version": SCHEMA_VERSION,
            **self._world(),
        }

    def describe(self) -> dict[str, Any]:
        """Return this run as plain values, those the user left out filled in."""
        return {
            "parameters": self.parameters.to_dict(),
            "schedule": self.schedule.to_dict(),
            "start": self.start.describe(),
            "solver": self.solver,
            "nodes": self.nodes,
            "options": {**_usual_options(self.solver), **self.options},
            "save_every": self.save_every,
            "t_end": self.t_end,
            **self._world(),
        }


@functools.cache
def _usual_options(solver: str) -> dict[str, Any]:
    """Return the options of a solver, but for its nodes, as they are unless given."""
    known = inspect.signature(SOLVERS[solver].__init__).parameters
    names = (name for name in SOLVERS[solver].OPTIONS if name in known and name != "nodes")
    return {name: known[name].default for name in names}


def solver_named(name: Any) -> type[Solver]:
    """Return the solver class of that name, or raise `InputError`."""
    return SOLVERS[one_of("solver", name, SOLVERS)]


def _check_steps(t_end: float, dt: Any) -> None:
    step = real_number("dt", dt, 0.0, 1e9, open_low=True)
    if t_end / step > _MOST_STEPS:
        raise InputError(
            f"dt = {step:g} makes {t_end / step:.3g} steps up to t_end = {t_end:g}: at most "
            f"{_MOST_STEPS:.0e} can be made"
        )


def _check_options(scheme: type[Solver], options: Mapping[str, Any]) -> None:
    for name in options:
        if name in scheme.OPTIONS:
            continue
        if name in _PARAMETERS:
            example = f"simulate(Parameters({name}=...))"
            raise InputError(f"{name} is a parameter of the cell: give it as in {example}")
        for kind in _STARTS:
            if name in kind.__dataclass_fields__:
                example = f"start={kind.__name__}({name}=...)"
                raise InputError(f"{name} belongs to the start: give it as in {example}")
        fields = [field for field in RunDescription.__dataclass_fields__ if field != "options"]
        hint = nearest_name(name, {*scheme.OPTIONS, *fields})
        raise InputError(f"solver {scheme.name!r} has no option {shown(name)}: {hint}")
