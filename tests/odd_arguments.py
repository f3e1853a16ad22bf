"""Calls of every public callable, and odd values to put in place of one argument of each."""

from __future__ import annotations

import contextlib
import datetime
import decimal
import fractions
import functools
import inspect
import math
import time
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.figure import Figure

import cellcrawl as cc
from cellcrawl.sweeps.executors import InProcess
from tests.infer.conftest import PRIOR, T_END, make_bank, swimmer
from tests.runs import circling

Arguments = dict[str, Any]


class Call(NamedTuple):
    """A public callable and arguments with which it works."""

    name: str
    function: Callable[..., Any]
    arguments: Callable[[], Arguments]


class Hostile:
    """An object whose every question about it fails."""

    def _fails(self, *_: Any) -> Any:
        raise RuntimeError("no")

    __repr__ = __str__ = __bool__ = __len__ = __iter__ = __float__ = __int__ = __index__ = _fails
    __array__ = __fspath__ = _fails
    __hash__ = object.__hash__


@functools.cache
def odd_values() -> list[Any]:
    """Return values that are wrong in most places: of wrong kinds, sizes, signs and boxes."""
    axes = Figure().subplots(2, 2)
    return [
        None, True, False, 0, -1, 1, 2, 7, 2**63, -(10**400), 10**5000, 0.0, -0.5, 1.5, 1e-300,
        1e300, 5e-324, math.nan, math.inf, -math.inf, 1j, complex(math.nan, 1),
        "", "x", "bound_fraction", "tension", "r_on", "front", "a\0b", "\ud800", "line\nline",
        "x" * 5000, b"", b"bytes", bytearray(2), Path("nowhere"), Path("nowhere.nc"), Path(),
        [], [1], [1, 2], [None], [[1], [1, 2]], ["r_on"], [math.nan], [[0, 0], [1, 0], [0, 1]], (),
        (1, 2), (2, 1), (math.nan, 1), ("a", "b"), {}, {"a": 1}, {1: 2}, {"r_on": [1, 2]}, set(),
        {1, 2}, frozenset({"x"}), range(3), iter([1, 2]), slice(1), Ellipsis, NotImplemented,
        object(), Hostile(), Hostile, len, lambda *_: 1, int, np, ValueError("x"),
        np.float32(1), np.float64(math.nan), np.int64(4), np.uint8(3), np.bool_(True),
        np.str_("x"), np.bytes_(b"x"), np.datetime64("2020"), np.timedelta64(1, "s"),
        np.complex128(1), np.array(1.0), np.array(3), np.array(True), np.array("x"),
        np.array(None), np.array([]), np.zeros(3), np.zeros((2, 2)), np.zeros((0, 2)),
        np.zeros((3, 2)), np.full(3, math.nan), np.array(["a", "b"]), np.array([True, False]),
        np.array([object()]), np.zeros(2, dtype=[("a", float)]), np.ma.masked_all(3),
        np.ma.masked, np.arange(12.0), np.array([1, 2]), np.array([1 + 1j]), np.longdouble(1),
        xr.DataArray(1.0), xr.DataArray([1.0, 2.0]), xr.DataArray([True, False]), xr.Dataset(),
        xr.Dataset({"time": ("time", [1.0])}), xr.Dataset({"x": 1}),
        run_without_records(),
        decimal.Decimal(1), decimal.Decimal("nan"), fractions.Fraction(1, 2),
        datetime.timedelta(1), datetime.datetime(2020, 1, 1), memoryview(b"ab"),
        axes, axes.ravel(), axes[0, 0], axes.ravel().tolist(), Figure(), Figure().add_subplot(),
        cc.Parameters(), cc.Parameters, cc.Schedule({}), cc.RandomPerturbation(), cc.Scales(),
        cc.Eigenmode(2), cc.PhysicalParameters(),
    ]  # fmt: skip


def run_without_records() -> xr.Dataset:
    """Return a run without records."""
    return circling(0.3, records=3).isel(time=slice(0))


def _fits(call: Callable[..., Call], folder: Path) -> Iterator[Call]:
    """Calls that fit made-up cells; networks are trained in five steps meanwhile."""
    infer, prior = cc.infer, PRIOR
    known = make_bank(90, folder / "known.h5")
    other = make_bank(90, folder / "other.h5", laws="stiffness")
    cells = [swimmer(25.0, 1e-3, seed, step=0.5) for seed in (1, 2, 3)]
    filmed = {"time_unit": (0.8, 1.25, "log"), "length_unit": 1.0, "pixel": 0.0, "error": 0.0,
              "outlines": None, "looks": 1, "seed": 0}  # fmt: skip
    trained = {**filmed, "network": None}
    with training_in(5):
        fits = infer.fit_all(cells, known, **filmed)
    film = cc.observe(cells[0].isel(time=slice(20, None)), pixel=0.1, frame=0.5)
    quick = training_in(5)
    yield call(infer.Range, low=1.0, high=2.0, scale="log")
    yield call(infer.Prior, ranges={"r_on": (15, 40)})
    yield call(
        infer.bank, prior=prior, runs=90, output=folder / "known.h5", laws="paper",
        parameters=None, t_end=T_END, seed=1, executor=InProcess(), workers=1, progress=False,
        adopt=False,
    )  # fmt: skip
    yield call(infer.open_bank, path=folder / "known.h5")
    yield call(
        quick(infer.fit), "cellcrawl.infer.fit", observed=film, bank=known, method="abc", **trained
    )
    yield call(
        quick(infer.fit_all), "cellcrawl.infer.fit_all", observed=cells, bank=known, method="abc",
        **trained,
    )  # fmt: skip
    yield call(
        quick(infer.choose), "cellcrawl.infer.choose", observed=cells[0], banks=[known, other],
        **filmed,
    )  # fmt: skip
    yield call(refused(infer.save_network, "only a fit by method='npe'"),
               "cellcrawl.infer.save_network", fit=fits[0],
               path=folder / "network.npz")  # fmt: skip
    yield call(infer.together, fits=fits)
    yield call(infer.compare, control=fits, treated=fits)
    yield call(infer.corner, fit=fits[0], truth={"r_on": 25.0})
    yield call(infer.foretold, fit=fits[0], count=1, seed=1)
    yield call(fits[0].interval, name="r_on", level=0.9)
    yield call(
        infer.report, fits=fits[:1], output=folder / "fit.html", command="", comparison=None,
        group=None, title="",
    )  # fmt: skip


def refused(function: Callable[..., Any], because: str = "") -> Callable[..., Any]:
    """Call what is refused even as it stands, for a reason; odd values are answered as ever."""

    @functools.wraps(function)
    def wrapped(**arguments: Any) -> Any:
        try:
            return function(**arguments)
        except cc.InputError as error:
            if because not in str(error):
                raise

    return wrapped


@contextlib.contextmanager
def training_in(steps: int) -> Iterator[None]:
    """Train networks in so few steps meanwhile; also a decorator."""
    from cellcrawl.infer import regression

    usual = regression._MOST_STEPS
    regression._MOST_STEPS = steps
    try:
        yield
    finally:
        regression._MOST_STEPS = usual


def styled(**options: Any) -> None:
    """Go into the style and out of it."""
    with cc.plot.styled(**options):
        pass


def public_calls(folder: Path) -> list[Call]:
    """Return a call of every public callable; runs, sweeps and files lie in ``folder``."""
    return list(_calls(folder))


def _calls(folder: Path) -> Iterator[Call]:
    p = cc.Parameters()
    run = cc.simulate(p, 0.4, nodes=32, save_every=0.1, rtol=1e-2)
    long = circling(0.5, records=120, step=0.2)
    file = folder / "run.nc"
    cc.simulate(p, 0.2, nodes=32, save_every=0.1, output=file, rtol=1e-2)
    sweep = cc.sweep(
        {"r_on": [20, 30], "zeta_1": [500, 600]}, folder / "sweep", InProcess(), t_end=0.1,
        keep="tracks", options={"rtol": 1e-2},
    )  # fmt: skip
    grid = sweep.grid
    late = cc.sweep(grid, folder / "late", InProcess(), t_end=5.3)  # has means of the measures
    t, x, y = (long[name].values for name in ("time", "centroid_x", "centroid_y"))
    one, observe, plot, linear = cc.one_dimensional, cc.observables, cc.plot, cc.linear
    square = [[0.9, 0.9], [-0.9, 0.9], [-0.9, -0.9], [0.9, -0.9]]
    curve = cc.RandomPerturbation().state(p, 256).curve
    scales = cc.Scales()

    def call(function: Callable[..., Any], called: str = "", /, **arguments: Any) -> Call:
        name = called or f"{function.__module__}.{getattr(function, '__qualname__', function)}"
        return Call(name, function, lambda: dict(arguments))

    def ax() -> Any:
        return Figure().add_subplot()

    # parameters
    yield call(cc.Parameters, **p.to_dict())
    yield call(cc.Parameters.from_dict, values={"r_on": 20})
    yield call(cc.Parameters.check_names, names=["r_on"])
    yield call(cc.Parameters.from_toml, source="r_on = 20.0")
    yield call(p.to_toml, path=folder / "p.toml")
    yield call(p.replace, r_on=30, elasticity="printed")
    yield call(cc.PhysicalParameters, **cc.PhysicalParameters().to_dict())
    yield call(
        cc.PhysicalParameters().at_temperature, temperature=300.0,
        energies=cc.ActivationEnergies(), reference=298.0,
    )  # fmt: skip
    yield call(cc.PhysicalParameters().quantity, name="radius")
    yield call(cc.PhysicalParameters.from_dimensionless, parameters=p, scales=scales)
    yield call(cc.ActivationEnergies, **cc.ActivationEnergies().to_dict())
    yield call(cc.Scales, **scales.to_dict())
    yield call(scales.to_physical, value=1.0, kind="length", as_quantity=False)
    yield call(scales.to_dimensionless, value=1.0, kind="length")
    yield call(scales.dataset, run=run)
    schedule = cc.Schedule({"r_on": [(0.0, 20.0), (1.0, 30.0)]})
    yield call(cc.Schedule, changes={"r_on": [(0.0, 20.0), (1.0, 30.0)]})
    yield call(schedule.at, parameters=p, time=0.5)
    yield call(schedule.before, parameters=p, time=0.5)
    yield call(schedule.next_break, time=0.5)
    yield call(schedule.varies, start=0.0, end=0.5)
    # laws and surroundings
    yield call(cc.laws.as_law, given="stiffness")
    yield call(cc.laws.Stiffness, chi=0.5)
    yield call(cc.laws.CatchSlip, catch=1.0, catch_force=0.5, slip=1.0, slip_force=1.0)
    yield call(cc.laws.check, law=cc.laws.Stiffness(), parameters=p)
    yield call(cc.laws.rest_state, parameters=p, laws=cc.laws.Stiffness(chi=0.5), curvature=0.0)
    yield call(cc.laws.rest_states, parameters=p, laws=cc.laws.Stiffness(chi=0.5), curvature=1.0)
    yield call(linear.growth_rates, parameters=p, k=2, laws="stiffness")
    yield call(
        cc.simulate, parameters=p, t_end=0.02, laws="stiffness", surroundings=None, rtol=1e-2,
        nodes=32,
    )  # fmt: skip
    yield call(cc.surroundings.as_surroundings, given=cc.surroundings.Stripes())
    yield call(cc.surroundings.Stripes, period=2.0, width=0.5, between=0.0, angle=0.0)
    yield call(cc.surroundings.Pattern, image=np.ones((3, 3)), pixel=0.5, parameter="r_on", x=0.0)
    yield call(cc.surroundings.Walls, corners=square, room=True, stiffness=1e4)
    yield call(cc.surroundings.Islands, discs=[[0.0, 0.0, 1.0]], outside=0.5)
    yield call(cc.surroundings.Pillars, discs=[[3.0, 0.0, 1.0]], stiffness=1e4)
    yield call(cc.surroundings.Gradient, parameter="r_on", x=1.0, least=0.0)
    yield call(cc.surroundings.TensionGradient, mu=100.0)
    yield call(cc.surroundings.AlongEdge, parameter="v_p", front=0.1, bend=-0.1, slow=0.02)
    yield call(
        cc.explore, what=cc.Parameters(r_on=24, zeta_1=540), seed=3, view="bare", laws="stiffness"
    )
    # branches
    ways = cc.branches
    cell = cc.Parameters(r_on=56, zeta_1=560)
    slow = ways.from_circle(cell)
    branch = slow.continue_in("r_on", 54.5)
    fork = branch.points("pitchfork")[0]
    (kept := folder / "branch.nc").unlink(missing_ok=True)
    branch[0].continue_in("r_on", 57.0, output=kept, spectra=False, most_states=2)
    boundary = ways.curve_of(fork, "zeta_1", most_points=2)
    yield call(ways.circle, parameters=cell, laws=None, nodes=17)
    yield call(ways.onsets, parameters=cell, name="r_on", low=50.0, high=60.0, laws=None)
    yield call(ways.from_circle, parameters=cell, name="r_on", near=57.0, speed=0.01, laws="paper")
    yield call(ways.onset_slope, parameters=cell, name="r_on", near=57.0, laws=None)
    yield call(ways.from_run, run=slow.dataset(), rest_area=math.pi)
    round_cell = cc.Parameters(r_on=60, zeta_1=400)
    yield call(
        refused(ways.orbit, "orbit"),
        "cellcrawl.branches.orbit",
        run=run,
        rest_area=None,
        nodes=None,
    )
    yield call(
        refused(ways.continue_orbit, "Orbit"), "cellcrawl.branches.continue_orbit", start=None,
        name="r_on", to=30.0, output=None, overwrite=False, spectra=False, most_orbits=2,
        largest_step=0.1, nodes=None,
    )  # fmt: skip
    missing = folder / "no-orbits.h5"
    yield call(
        refused(ways.open_orbits, "no-orbits"), "cellcrawl.branches.open_orbits", path=missing
    )
    yield call(
        refused(ways.resume_orbits, "no-orbits"), "cellcrawl.branches.resume_orbits", path=missing,
        to=None, most_orbits=2, largest_step=0.1,
    )  # fmt: skip
    yield call(
        ways.lyapunov_exponent, parameters=round_cell, start=None, t_end=40.0, settle=0.0,
        laws=None, nodes=None, early=True, runs=1,
    )  # fmt: skip
    (chart := folder / "map.nc").unlink(missing_ok=True)
    exponents = ways.lyapunov_map(round_cell, r_on=[60.0], zeta_1=[400.0], output=chart)
    yield call(
        ways.lyapunov_map, parameters=round_cell, r_on=[60.0], zeta_1=[400.0], seed=1, t_end=40.0,
        laws=None, early=True, output=None, executor=InProcess(),
    )  # fmt: skip
    yield call(ways.open_lyapunov_map, path=chart)
    yield call(cc.plot.lyapunov_map, found=exponents, limit=0.05, legend=True, ax=ax())
    yield call(
        ways.basins, parameters=round_cell, starts=1, amplitude=0.01, t_end=20.0, laws=None,
        executor=InProcess(),
    )  # fmt: skip
    yield call(
        refused(ways.threshold_kick, "kick"), "cellcrawl.branches.threshold_kick",
        parameters=round_cell, kick=ways.Swollen, low=0.0, high=0.01, within=0.5, t_end=20.0,
        laws=None,
    )  # fmt: skip
    yield call(ways.Swollen, kick=0.01, front=1e-4)
    yield call(ways.gliding, parameters=cell, laws=None)
    yield call(ways.turning, parameters=cell.replace(r_on=50), laws=None)
    yield call(
        ways.continue_in, state=branch[-1], name="r_on", to=54.3, output=folder / "b.nc",
        overwrite=True, spectra=False, most_states=2, largest_step=0.05,
    )  # fmt: skip
    yield call(ways.open_branch, path=kept)
    yield call(ways.resume_branch, path=kept, to=56.9, most_states=3, largest_step=0.1)
    yield call(
        refused(ways.from_hopf, "Hopf"), "cellcrawl.branches.from_hopf", point=fork,
        amplitude=0.01, nodes=256,
    )  # fmt: skip
    yield call(ways.branch_off, point=fork, amplitude=0.05)
    yield call(
        ways.curve_of, point=fork, second="zeta_1", within={"zeta_1": (559.0, 561.0)},
        most_points=2, largest_step=0.05,
    )  # fmt: skip
    yield call(cc.plot.branch, branches=[branch], quantity="speed", legend=True, ax=ax())
    yield call(cc.plot.branch_panels, branches=[branch], title="at 560")
    yield call(cc.plot.boundaries, curves=[boundary], onset=True, legend=True, ax=ax())
    # starts
    yield call(cc.RandomPerturbation, seed=2, amplitude=1e-4, modes=10)
    yield call(cc.PerturbedCircle, radius={2: (0.1, 0.0)}, bound_fraction={2: (0.1, 0.0)})
    yield call(cc.Eigenmode, k=2, amplitude=1e-4, branch="+", carrier="radius")
    yield call(cc.Eigenmode(2).growth_rate, parameters=p)
    yield call(
        cc.FromOutline, xy=square, bound_fraction=[0.3] * 4, tension=900.0, radius=1.0,
        smoothing=0.02,
    )  # fmt: skip
    yield call(cc.FromRun, run=run, record=1)
    yield call(cc.FromRun(run).state, parameters=p, nodes=32)
    yield call(lambda record: cc.FromRun(run, record).describe(), "FromRun.describe", record=1)
    for start in (
        cc.RandomPerturbation(modes=5), cc.Eigenmode(2), cc.FromOutline(square),
        cc.PerturbedCircle(radius={2: (0.1, 0.0)}),
    ):  # fmt: skip
        yield call(start.state, parameters=p, nodes=64)
    yield call(cc.CellState, curve=curve, bound_fraction=np.full(curve.nodes, 0.3), tension=900.0)
    yield call(cc.Curve, theta=curve.theta, length=curve.length, origin=np.zeros(2))
    yield call(curve.resampled, nodes=64)
    yield call(curve.moved, shift=[1.0, 0.0])
    # simulation
    yield call(
        cc.simulate, parameters=p, t_end=0.02, start=cc.RandomPerturbation(), save_every=0.1,
        solver="adaptive", nodes=32, schedule=cc.Schedule({}), output=None, overwrite=False,
        progress=False, rtol=1e-2,
    )  # fmt: skip
    yield call(
        cc.simulate, parameters=p, t_end=0.002, solver="paper", nodes=256, dt=1e-3,
        start=cc.RandomPerturbation(modes=5),
    )  # fmt: skip
    yield call(cc.open_run, path=file)
    yield call(cc.resume, path=file, t_end=0.2, progress=False)
    # linear
    yield call(linear.base_state, parameters=p)
    yield call(linear.growth_rates, parameters=p, k=[1, 2], r_on=20.0)
    yield call(linear.fastest_decay, parameters=p)
    yield call(linear.fastest_mode, parameters=p)
    yield call(linear.unstable_modes, parameters=p)
    yield call(linear.cutoff_wavenumber, parameters=p, r_on=[20.0, 30.0])
    yield call(
        linear.evolution, parameters=p, k=2, radius=1e-4, bound_fraction=0j, times=[0.0, 1.0]
    )
    ranges = {"r_on": [10.0, 20.0, 30.0], "zeta_1": [300.0, 600.0, 900.0]}
    stability = linear.stability_map(p, k=(1, 2), **ranges)
    yield call(linear.stability_map, parameters=p, k=(1, 2), **ranges)
    yield call(linear.marginal_curves, parameters=p, k=2, **ranges)
    yield call(linear.curves_in, stability=stability, k=2)
    yield call(linear.hopf_points, parameters=p, k=2, r_on=(1.0, 100.0))
    yield call(linear.oscillation_onset, parameters=p, k=2, r_on=(1.0, 100.0))
    # microscopy
    observed = cc.observe(run, pixel=0.05)
    cells = folder / "cells.csv"
    cells.write_text(
        "track,t,x,y\n" + "".join(f"1,{a},{b},{c}\n" for a, b, c in zip(t, x, y, strict=True))
    )
    read = cc.read_tracks(cells)
    yield call(cc.observe, run=run, pixel=0.1, error=0.0, frame=0.2, edge_error=0.0, seed=1)
    yield call(
        cc.read_tracks, path=cells, columns=None, frame_interval=None, pixel_size=None,
        image_coordinates=False,
    )  # fmt: skip
    yield call(cc.write_tracks, path=folder / "out.csv", tracks=read, form=None)
    seen = folder / "cells.geojson"
    yield call(
        cc.write_outlines, path=seen, outlines=list(observed.outlines), form=None, pixel=0.05
    )
    cc.write_outlines(seen, observed.outlines)
    yield call(
        cc.read_outlines, path=seen, frame_interval=None, pixel_size=None, image_coordinates=False
    )
    # observables
    for name in observe.__all__:
        function = getattr(observe, name)
        if inspect.isclass(function):
            continue
        usual: Arguments = {
            "dataset": long, "run": t, "x": x, "y": y, "field": "bound_fraction", "k": [1, 2],
            "origin": "front", "after": 1.0, "longest": 5.0, "smallest": 0.3,
            "kind": "direction", "t": t, "values": x, "exposure": 0.0, "tracks": read,
            "drift": observe.shared_drift(read), "outlines": observed.outlines, "nodes": 64,
            "tolerance": 0.1, "modes": 2, "points": 32, "normalise": True, "reflect": False,
        }  # fmt: skip
        if name == "fourier_amplitude":
            usual["dataset"] = run
        known = inspect.signature(function).parameters
        if name == "shape_modes":
            series = observe.edge_series(observed.outlines)
            given = {n: usual[n] for n in known if n in usual}
            yield call(
                lambda one, **named: observe.shape_modes(one, **named), name, one=series, **given
            )
            continue
        if name == "edge_series":
            known = [n for n in known if n != "t"]  # the outlines know theirs
        yield call(function, **{name: usual[name] for name in known})
        if "run" in known:
            yield call(function, f"{function.__name__} of a run", run=long)
    # modes
    yield call(cc.classify, dataset=long, use_size=True)
    yield call(cc.classify_track, t=t, x=x, y=y, cell_radius=1.0, status="completed")
    yield call(lambda used: cc.cite(used), "cellcrawl.cite", used=run)
    yield call(cc.modes.combine, results=[cc.classify(long)])
    yield call(cc.modes.is_long_enough, dataset=long)
    # one dimension
    edges = one.simulate_two_edges(p, 0.5)
    flat = one.simulate_flat_edge(p, 0.05, nodes=64)
    yield call(one.Anchoring, stiffness=1.0, relaxation=1.0)
    yield call(one.TwoEdges, front=0.3, rear=0.4, tension=100.0)
    yield call(one.FlatNoise, seed=1, amplitude=0.01, waves=3)
    yield call(one.FlatWave, waves=1, amplitude=0.01, direction=1)
    yield call(one.StuckPatch, part=0.5)
    yield call(one.FlatFields, bound_fraction=np.full(64, 0.3), height=np.zeros(64))
    for function in (
        one.crawling_states, one.length_stiffness, one.still_tension,
    ):  # fmt: skip
        yield call(function, parameters=p)
    yield call(one.still_tension, parameters=p, laws="paper")
    yield call(one.crawling_states, parameters=p, anchoring=one.Anchoring(), laws="paper")
    yield call(one.front_speed, parameters=p, tension=one.still_tension(p), laws="paper")
    yield call(one.uniform_states, parameters=p, tension=100.0, laws="paper")
    yield call(
        one.boundaries, parameters=p, which="symmetric", anchoring=one.Anchoring(), laws="paper",
        **{name: values[:2] for name, values in ranges.items()},
    )  # fmt: skip
    yield call(
        one.growth_rates, parameters=p, symmetry="symmetric", anchoring=one.Anchoring(),
        laws="paper", r_on=[20.0],
    )  # fmt: skip
    yield call(
        one.flat_growth_rates, parameters=p, k=[1, 2], off_rate=50.0, tension_law="fixed",
        length=6.0, anchoring=0.0, laws="paper",
    )  # fmt: skip
    yield call(
        one.simulate_flat_edge, parameters=p, t_end=0.01, tension=100.0, tension_law="fixed",
        length=6.0, start=one.FlatNoise(), anchoring=0.0, nodes=64, save_every=0.01, rtol=1e-3,
        laws="paper",
    )  # fmt: skip
    yield call(
        one.simulate_two_edges, parameters=p, t_end=0.1, start="small", save_every=0.02,
        rtol=1e-4, anchoring=one.Anchoring(), laws="paper",
    )  # fmt: skip
    yield call(one.regime, dataset=edges, after=0.1, threshold=0.02)
    yield call(one.stuck_length, dataset=flat, level=0.5)
    yield call(one.wave_velocity, dataset=flat)
    # fits
    yield from _fits(call, folder)
    # sweeps
    yield call(
        cc.Grid, axes={"r_on": [20, 30]}, points=[{"D": 0.1}], parameters=p,
        start=cc.RandomPerturbation(), schedule=cc.Schedule({}), t_end=1.0, save_every=0.1,
        solver="adaptive", nodes=32, options={"rtol": 1e-3},
    )  # fmt: skip
    yield call(cc.Grid.from_dict, content={"r_on": [20, 30]}, t_end=1.0, parameters=p)
    yield call(cc.Grid.from_toml, source="[axes]\nr_on = [20, 30]\n", t_end=1.0)
    yield call(grid.run, index=1)
    yield call(grid.replace, t_end=2.0, axes={"r_on": [20]})
    yield call(
        cc.sweep, grid=grid, output=sweep.path, executor=InProcess(), workers=1, keep="tracks",
        extend=False, retry=False, part=(0, 1), progress=False, t_end=0.1,
    )  # fmt: skip
    yield call(cc.open_sweep, path=sweep.path, grid=grid)
    yield call(cc.Sweep, path=sweep.path, grid=grid, interrupted=False)
    yield call(sweep.table, columns=["r_on"])
    yield call(sweep.run, r_on=20.0, zeta_1=500.0)
    yield call(sweep.failures, most=3)
    yield call(sweep.is_of, grid=grid)
    # pictures
    limits = (0.1, 0.8)
    yield call(
        plot.cell, dataset=run, time=0.2, field="bound_fraction", limits=limits, velocity=True,
        colorbar=True, colormap="magma", ax=ax(),
    )  # fmt: skip
    yield call(
        plot.snapshots, dataset=run, times=[0.1, 0.2], field="bound_fraction", limits=limits,
        velocity=False, colorbar=True, colormap="magma", axes=list(Figure().subplots(2)),
    )  # fmt: skip
    yield call(
        plot.cycle, dataset=long, start=1.0, duration=10.0, shapes=3, quantity="tension",
        field="bound_fraction", limits=limits, colormap="magma", colorbar=False,
        axes=list(Figure().subplots(2)),
    )  # fmt: skip
    yield call(plot.diagram, sweep=sweep, x="r_on", y="zeta_1", legend=True, size=3.0, ax=ax())
    yield call(
        plot.measure_map, sweep=late, measure="area", x="r_on", y="zeta_1", colorbar=True,
        limits=(0.0, 5.0), colormap="magma", ax=ax(),
    )  # fmt: skip
    yield call(
        plot.dispersion,
        parameters=p,
        k_max=5.0,
        legend=True,
        axes=list(Figure().subplots(2)),
        r_on=[20, 30],
    )
    yield call(
        plot.flat_edge, dataset=flat, field="bound_fraction", limits=limits, colormap="magma",
        colorbar=True, ax=ax(),
    )  # fmt: skip
    yield call(plot.growth, dataset=run, k=(1, 2), field="bound_fraction", legend=True, ax=ax())
    yield call(
        plot.kymograph, dataset=run, field="bound_fraction", origin="front", limits=limits,
        colormap="magma", colorbar=True, ax=ax(),
    )  # fmt: skip
    yield call(
        plot.kymographs, dataset=run, fields=["friction", "theta"], origin="front",
        limits={"friction": (0.0, 9e3)}, colormap="magma", colorbar=False,
        axes=list(Figure().subplots(2, 1)),
    )  # fmt: skip
    yield call(
        plot.paths, runs={"one": run, "two": run}, every=0.2, field="bound_fraction",
        limits=limits, colormap="magma", colorbar=True,
    )  # fmt: skip
    yield call(styled, rc={"lines.linewidth": 2.0}, width=3.0, font_size=9.0, colormap="magma")
    yield call(
        plot.path, dataset=run, every=0.2, field="bound_fraction", limits=limits, colorbar=True,
        times=True, colormap="magma", ax=ax(),
    )  # fmt: skip
    yield call(plot.tracks, tracks=read, results=[cc.classify(long)], title="one", examples=1)
    yield call(plot.outlines, given=observed.outlines[:2], title="two")
    yield call(
        plot.compare_tracks, series={"a": read, "b": read},
        results={name: [cc.classify(long)] for name in "ab"},
    )  # fmt: skip
    diagram = one.phase_diagram(
        p,
        t_end=1.0,
        starts=["small"],
        rtol=1e-3,
        **{name: values[:2] for name, values in ranges.items()},
    )
    yield call(plot.regimes, diagram=diagram, lines=False)
    yield call(plot.stability, stability_map=stability, legend=True, ax=ax())
    yield call(
        plot.summary, dataset=run, every=0.2, field="bound_fraction", limits=limits,
        colormap="magma",
    )  # fmt: skip
    yield call(plot.time_series, dataset=run, quantities=["tension"], axes=[ax()])
    yield call(plot.two_edges, dataset=edges, axes=list(Figure().subplots(3, 1)))
    yield call(
        one.phase_diagram, parameters=p, starts=["small"], t_end=1.0, rtol=1e-3,
        anchoring=one.Anchoring(), laws="paper",
        **{name: values[:2] for name, values in ranges.items()},
    )  # fmt: skip
    yield call(
        cc.movie, dataset=run, path=folder / "cell.gif", fps=25.0, seconds=0.1, every=None,
        view="follow", field="bound_fraction", limits=limits, colormap="magma", size=(64, 64),
        progress=False,
    )  # fmt: skip
    yield call(
        cc.sweeps.refine, grid=grid, output=sweep.path, executor=InProcess(), levels=1, x="r_on",
        y="zeta_1", workers=1, keep="tracks", progress=False, t_end=0.1,
    )  # fmt: skip


class Answers(NamedTuple):
    """What odd calls gave: raw errors by call, argument and number of the value; counts."""

    raw: dict[tuple[str, str, int], str]
    refused: int
    slowest: tuple[float, str]
    """Seconds, and the call."""


def odd_calls(calls: list[Call], seed: int, count: int) -> Answers:
    """Make calls with one odd value each, drawn by ``seed``."""
    draw = np.random.default_rng(seed)
    raw, refused, slowest = {}, 0, (0.0, "")
    for _ in range(count):
        call = calls[draw.integers(len(calls))]
        arguments = call.arguments()
        name = str(draw.choice(list(arguments)))
        number = int(draw.integers(len(odd_values())))
        arguments[name] = odd_values()[number]
        began = time.perf_counter()
        error = raw_error(call.function, arguments)
        slowest = max(slowest, (time.perf_counter() - began, f"{call.name}, {name}, {number}"))
        refused += error == REFUSED
        if error not in ("", REFUSED):
            raw[call.name, name, number] = error
    return Answers(raw, refused, slowest)


REFUSED = "refused in one line"


def raw_error(function: Callable[..., Any], arguments: Arguments) -> str:
    """Return nothing, `REFUSED`, or the error of a call that is none of ours or of many lines."""
    try:
        with warnings.catch_warnings(), mpl.rc_context():
            warnings.simplefilter("ignore")
            function(**arguments)
    except cc.CellcrawlError as error:
        text = str(error)
        return REFUSED if text and len(text) < 700 and "\n" not in text else f"long: {text[:300]!r}"
    except Exception as error:
        return f"{type(error).__name__}: {str(error)[:160]}"
    return ""
