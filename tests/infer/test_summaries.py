"""Summaries do not change with place, direction or handedness, and say what a pixel does."""

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.infer import films
from cellcrawl.infer.cells import cells_of
from cellcrawl.infer.microscope import Microscope, look, summaries_of
from cellcrawl.infer.summaries import Films, summaries
from tests.infer.conftest import swimmer


def film(turning=0.1, seed=1):
    (cell,) = cells_of(swimmer(25.0, 1e-3, seed, step=0.5, turning=turning))
    return cell.film(1.0, 1.0)


def seen(one):
    return summaries(one)[1][0]


def same(one, other):
    assert seen(other) == pytest.approx(seen(one), abs=1e-6)


def test_place_and_direction_do_not_count():
    one = film()
    turn = np.exp(1.3j)
    same(one, Films(one.step, turn * one.path + 40 - 3j, turn * one.modes))


def test_handedness_does_not_count():
    one = film()
    # A mirrored outline runs clockwise: turned round, wave k is the conjugate of wave k again.
    same(one, Films(one.step, np.conj(one.path), np.conj(one.modes)))


def test_where_a_tracing_begins_does_not_count():
    one = film()
    start = np.linspace(0, 5, one.path.shape[1])[None, :, None]
    same(one, Films(one.step, one.path, one.modes * np.exp(1j * start * films.WAVES)))


def test_the_size_of_the_cell_does_not_count_where_outlines_show_it():
    one = film()
    same(one, Films(one.step, 7 * one.path, 7 * one.modes))


def test_all_are_finite_and_named_once_also_for_a_cell_that_stands_still():
    one = film()
    still = Films(one.step, 0 * one.path, one.modes * 0 + one.modes[:, :1])
    told, values = summaries(still)
    assert np.isfinite(values).all()
    assert len({one.name for one in told}) == len(told) == values.shape[1]
    track = summaries(Films(one.step, one.path, None))
    assert not any(one.outlines for one in track[0])


def test_modes_of_an_edge_give_the_edge_back():
    run = swimmer(25.0, 1e-3, 2)
    edge = run.x.values + 1j * run.y.values - (run.centroid_x + 1j * run.centroid_y).values[:, None]
    assert films.edge_of_modes(films.modes_of_edge(edge.real, edge.imag)) == pytest.approx(edge)


def test_a_polygon_is_measured_at_equal_arclength():
    angle = 2 * np.pi * (np.arange(256) + 0.3 * np.sin(2 * np.pi * np.arange(256) / 256)) / 256
    even = films.equal_arclength(np.exp(1j * angle)[None])[0]
    steps = np.abs(np.diff(np.append(even, even[0])))
    assert steps == pytest.approx(np.full(films.NODES, steps.mean()), rel=1e-3)


def test_the_quick_camera_sees_what_the_microscope_sees():
    """Its pixels are edge errors; `observe` draws pixels. Both change summaries alike."""
    run = swimmer(25.0, 1e-3, 3, step=0.5)
    late = run.isel(time=run.time.values >= films.TRANSIENT)
    (plain,) = cells_of(run)
    ideal = seen(plain.film(1.0, 1.0))
    (cell,) = cells_of(cc.observe(late, pixel=0.1, frame=0.5))
    assert cell.pixel == pytest.approx(0.1)
    there = seen(cell.film(1.0, 1.0))
    microscope = Microscope(0.5, len(plain.path), 0.1, 0.0, 1.0, 1.0, 1.0)
    from cellcrawl.infer.microscope import _noisy

    random = np.random.default_rng(1)
    rough = [
        _noisy(plain.path[None], plain.modes[None], microscope, np.ones(1), random)
        for _ in range(8)
    ]
    here = np.array([seen(Films(0.5, *one)) for one in rough])
    names = [one.name for one in summaries(plain.film(1.0, 1.0))[0]]
    for name in ("log rms edge velocity over 1 frames", "log mean of waves beyond 5"):
        place = names.index(name)
        # What pixels add to the ideal film is added by both, to a third of it.
        added = there[place] - ideal[place]
        assert here[:, place].mean() - ideal[place] == pytest.approx(added, abs=0.35)


def test_looks_count_every_run(bank):
    microscope = Microscope(1.0, 24, 0.0, 0.0, 1.0, 1.0, 1.0)
    view = look(bank, microscope, 2)
    assert sum(view.outcomes.values()) == 2 * len(bank)
    assert view.outcomes["resting"] == 16
    assert view.outcomes["ended before: fragmented"] == 16
    assert view.outcomes["seen"] == len(view.run) == len(view.summaries)
    assert np.isfinite(view.summaries).all()
    one = film()
    short = Films(1.0, one.path[:, :24], one.modes[:, :24])
    assert [t.name for t in summaries_of(short, microscope)[0]] == [t.name for t in view.told]
