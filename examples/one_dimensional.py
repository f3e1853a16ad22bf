"""The model on a line: regimes of two edges, bistability, phase diagrams, waves on a flat edge.

Makes the pictures of the documentation and says the numbers in it, in about two minutes:

    python examples/one_dimensional.py docs/images/one_dimensional
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import cellcrawl as cc
from cellcrawl.plot.style import COLUMN, PAGE, paper_figure
from cellcrawl.plot.symbols import parameter_label
from cellcrawl.plot.two_edges import EDGE_COLOURS

od = cc.one_dimensional

PRINTED = cc.Parameters()
CONSISTENT = cc.Parameters(elasticity="consistent")
BODY = od.Anchoring(stiffness=500.0, relaxation=1.0)
# title: parameters, options, the window to draw
REGIMES = {
    "still": (PRINTED.replace(r_on=25, zeta_1=400), {"start": "large"}, 4.0),
    "crawling": (PRINTED.replace(r_on=25, zeta_1=600), {}, 4.0),
    "stick-slip": (PRINTED.replace(r_on=60, zeta_1=800), {}, 4.0),
    "stepping": (PRINTED.replace(r_on=48, zeta_1=700), {}, 4.0),
    "bipedal": (CONSISTENT.replace(r_on=16, zeta_1=560), {"anchoring": BODY}, 4.0),
}
PLANE = {"r_on": np.linspace(4, 80, 39), "zeta_1": np.linspace(400, 900, 26)}
BISTABLE = cc.Parameters(r_on=10, zeta_1=600)
# The same product epsilon h as the paper's, at a tenth of its epsilon: the same waves, a tenth as
# steep, so that the gentle slope the flat edge assumes is one.
# Where both ends of the stuck stretch travel equally fast, found by trying.
HELD = 928.36
EDGE = cc.Parameters(r_on=26, zeta_1=600, epsilon=1e-4, h=0.1, elasticity="consistent")


def all_regimes() -> Figure:
    """Draw one cell of each regime, late in its run, and say what the rule measures."""
    with paper_figure(PAGE, 3.5) as figure:
        axes = figure.subplots(3, len(REGIMES), sharex="col", height_ratios=(1.3, 1.0, 1.0))
        for column, (title, (cell, options, window)) in zip(axes.T, REGIMES.items(), strict=True):
            run = od.simulate_two_edges(cell, 60.0, **options)
            found = od.regime(run)
            print(f"{title}: {found}")
            assert found.name == title
            part = run.sel(time=slice(60.0 - window, None))
            shift = part["position"].mean("edge")[0].item()
            part = part.assign(position=part["position"] - shift)
            cc.plot.two_edges(part.assign_coords(time=part.time - part.time[0]), axes=column)
            column[0].set_title(title, loc="left")
            column[0].set_ylim(-1.9, 1.9)
            column[2].set_xlabel("time $t$")
        axes[0, 0].set_ylabel("position $x$ ($R_0$)")
        axes[1, 0].set_ylabel("bound fraction $n$")
        axes[2, 0].set_ylabel(r"tension $\sigma$")
        axes[1, 1].legend(frameon=False, handlelength=1.2, loc="center right")
        figure.align_ylabels(axes[:, 0])
    return figure


def growth() -> Figure:
    """Draw the growth rates over adhesion strength, from theory and from runs."""
    strengths = np.linspace(300.0, 900.0, 121)
    colours = {"antisymmetric": "#56607a", "symmetric": "#b5338a"}
    worst = 0.0
    with paper_figure(COLUMN, 2.3) as figure:
        ax = figure.add_subplot()
        for symmetry, colour in colours.items():
            rates = od.growth_rates(PRINTED, symmetry, zeta_1=strengths)
            moves = rates[:, 0] if symmetry == "symmetric" else rates.sum(axis=1)  # no shift
            ax.plot(strengths, moves.real, color=colour, label=f"{symmetry}, growth")
            if symmetry == "symmetric":
                ax.plot(strengths, moves.imag, color=colour, linestyle="--", label="frequency")
            for strength in strengths[5::10]:
                found = _measured_rate(PRINTED.replace(zeta_1=float(strength)), symmetry)
                exact = od.growth_rates(PRINTED, symmetry, zeta_1=strength)
                worst = max(worst, float(np.abs(found - exact).min() / np.abs(exact).max()))
                ax.plot(strength, found.real, "o", color=colour, markersize=3)
                if symmetry == "symmetric":
                    ax.plot(strength, found.imag, "o", color=colour, markersize=3)
        ax.axhline(0.0, color="#999999", linewidth=0.5)
        ax.set(xlabel=parameter_label("zeta_1"), ylabel="rate ($k_\\mathrm{off}^0$)")
        ax.legend(frameon=False)
        ax.spines[["top", "right"]].set_visible(False)
    print(f"growth rates of runs and theory differ by {worst:.1e} at most")
    return figure


def _measured_rate(cell: cc.Parameters, symmetry: str) -> complex:
    """Rate of a small perturbation, from the recurrence that its records obey."""
    size, side = 1e-6, 1.0 if symmetry == "symmetric" else -1.0
    start = od.TwoEdges(front=cell.n_bar + size, rear=cell.n_bar + side * size)
    run = od.simulate_two_edges(cell, 0.1, start=start, save_every=0.01, rtol=1e-11)
    n = (run.bound_fraction.values @ [0.5, 0.5 * side] - (side > 0) * cell.n_bar) / size
    if side < 0:
        return complex(np.log(n[-1] / n[0]) / 0.1)
    past = np.column_stack([n[1:-1], n[:-2]])
    last, before = np.linalg.lstsq(past, n[2:], rcond=None)[0]
    return complex(np.log(max(np.roots([1.0, -last, -before]), key=np.imag)) / 0.01)


def bistability() -> Figure:
    """Draw how asymmetries of all sizes end at one point, with the states theory gives."""
    saddle, crawling = od.crawling_states(BISTABLE)
    with paper_figure(COLUMN, 2.1) as figure:
        ax = figure.add_subplot()
        for state, style in ((crawling, "-"), (saddle, (0, (3.0, 1.5)))):
            front, rear = state.bound_fractions
            ax.axhline(front - rear, color="#999999", linewidth=3.0, linestyle=style, alpha=0.5)
            name = "crawls" if state.stable else "crawls, unstable"
            ax.annotate(name, (2.95, front - rear + 0.02), ha="right")
        ax.axhline(0.0, color="#999999", linewidth=3.0, alpha=0.5)
        ax.annotate("still", (2.95, 0.02), ha="right")
        for asymmetry in (0.01, 0.05, 0.1, 0.14, 0.16, 0.2, 0.3, 0.5, 0.75):
            start = od.TwoEdges(
                front=BISTABLE.n_bar + 0.7 * asymmetry,
                rear=max(0.0, BISTABLE.n_bar - 0.3 * asymmetry),
            )
            run = od.simulate_two_edges(BISTABLE, 3.0, start=start)
            n = run["bound_fraction"]
            difference = n.sel(edge="front") - n.sel(edge="rear")
            moves = bool(difference[-1] > 0.1)
            ax.plot(run.time, difference, color=EDGE_COLOURS["front" if moves else "rear"])
        ax.set(
            xlabel="time $t$ ($1/k_\\mathrm{off}^0$)",
            ylabel="asymmetry $n_\\mathrm{front}-n_\\mathrm{rear}$",
            xlim=(0.0, 3.0),
        )
        ax.spines[["top", "right"]].set_visible(False)
    print(f"bistable at (10, 600): {saddle}, {crawling}")
    return figure


def diagrams(folder: Path) -> None:
    """Label the plane of on-rate and adhesion strength for both laws, and with a body."""
    for name, cell, options in (
        ("printed", PRINTED, {}),
        ("consistent", CONSISTENT, {}),
        ("body", CONSISTENT, {"anchoring": BODY, "starts": ("small", "large")}),
    ):
        diagram = od.phase_diagram(cell, **PLANE, **options)
        counts = {
            label: int((diagram.regime == code).sum()) for code, label in enumerate(od.REGIMES)
        }
        print(f"{name}: {counts}, bistable {int(diagram.bistable.sum())}")
        cc.plot.regimes(diagram).savefig(folder / f"diagram-{name}.png", dpi=200)


def waves(folder: Path) -> None:
    """Draw waves that travel along the flat edge: from noise, and at a tension that is held."""
    free = od.simulate_flat_edge(EDGE, 40.0, tension_law="elastic", save_every=0.05)
    last = free.isel(time=-1)
    pattern = od.FlatFields(bound_fraction=last.bound_fraction.values, height=last.height.values)
    held = od.simulate_flat_edge(EDGE, 40.0, tension=HELD, start=pattern)
    cell = EDGE.replace(epsilon=1e-3, h=0.2)
    train = od.simulate_flat_edge(cell, 1.0, start=od.FlatWave(waves=3, amplitude=0.01), nodes=512)
    for name, run in (("free", free), ("held", held), ("train", train)):
        moving = od.wave_velocity(run)
        late = moving.isel(time=slice(-run.sizes["time"] // 4, None))
        print(
            f"{name}: velocity {late.velocity.mean().item():.3f}, coherence "
            f"{late.coherence.mean().item():.4f}, slope {run.attrs['largest_slope']:.2f}, stuck "
            f"{od.stuck_length(run, 0.45)[-1].item():.2f}, tension {run.tension[-1].item():.1f}"
        )
    rate = od.flat_growth_rates(cell, 3)[0]
    first = od.wave_velocity(train).velocity[0].item()
    print(f"train: theory {rate}, velocity {rate.imag / 3:.3f}, at first {first:.3f}")
    with paper_figure(PAGE, 2.0) as figure:
        panels = figure.subplots(1, 3, width_ratios=(1.0, 1.0, 1.0))
        for panel, run, title in zip(
            panels,
            (free, held, train),
            (
                "elastic tension, from noise",
                "from there at a held tension",
                "a wave of linear theory",
            ),
            strict=True,
        ):
            cc.plot.flat_edge(run, ax=panel)
            panel.set_title(title, loc="left")
            panel.set_xlabel("time $t$ ($1/k_\\mathrm{off}^0$)")
        for panel in panels[1:]:
            panel.set_ylabel("")
    figure.savefig(folder / "waves.png", dpi=200)


def fronts() -> Figure:
    """Draw the speed of fronts against the tension, from runs and from theory."""
    tensions = np.linspace(875.0, 950.0, 7)
    cell = cc.Parameters(r_on=25, zeta_1=600, h=0.0)
    with paper_figure(COLUMN, 2.1) as figure:
        ax = figure.add_subplot()
        fine = np.linspace(872.0, 955.0, 60)
        ax.plot(
            fine, [od.front_speed(cell, t) for t in fine], color="#56607a", label="theory, $h=0$"
        )
        for h, marker, colour in ((0.0, "o", "#0072b2"), (0.01, "s", "#d55e00")):
            speeds = [_front(cell.replace(h=h), tension) for tension in tensions]
            print(f"fronts at h = {h}: {np.round(speeds, 4)}")
            label = f"runs, $h={h:g}$"
            ax.plot(tensions, speeds, marker, color=colour, markersize=3.5, label=label)
        ax.axhline(0.0, color="#999999", linewidth=0.5)
        ax.set(xlabel=r"tension $\sigma$ ($\zeta_0 v_\beta/2$)", ylabel="speed of a sticking front")
        ax.legend(frameon=False)
        ax.spines[["top", "right"]].set_visible(False)
    theory = [od.front_speed(cell, float(tension)) for tension in tensions]
    print(f"fronts, theory: {np.round(theory, 4)}")
    return figure


def _front(cell: cc.Parameters, tension: float) -> float:
    """Speed at which the stuck stretch grows at either end."""
    run = od.simulate_flat_edge(cell, 0.8, tension=tension, start=od.StuckPatch(), length=4.0)
    grown = od.stuck_length(run).sel(time=slice(0.3, 0.7))
    return 0.5 * float(np.polyfit(grown.time.values, grown.values, 1)[0])


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    all_regimes().savefig(folder / "regimes.png", dpi=200)
    growth().savefig(folder / "growth.png", dpi=200)
    bistability().savefig(folder / "bistability.png", dpi=200)
    waves(folder)
    fronts().savefig(folder / "fronts.png", dpi=200)
    diagrams(folder)
    p = cc.Parameters(r_on=25, zeta_1=600)
    for symmetry in ("symmetric", "antisymmetric"):
        for cell in (p, p.replace(elasticity="consistent")):
            print(symmetry, cell.elasticity, od.growth_rates(cell, symmetry))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "one-dimensional"))
