"""Summaries do not change with place, direction or handedness, and say what a pixel does."""

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.infer import camera, films
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


def test_the_bank_s_camera_sees_what_the_microscope_sees():
    """It draws no image; `observe` does. Both change summaries alike, to a third of the change."""
    pixel, error = 0.1, 0.05
    random = np.random.default_rng(1)
    there, here, ideal = [], [], []
    for seed in range(6):
        run = swimmer(25.0, 1e-3, seed, step=0.5)
        late = run.isel(time=run.time.values >= films.TRANSIENT)
        (plain,) = cells_of(run)
        ideal.append(seen(plain.film(1.0, 1.0)))
        film = cc.observe(late, pixel=pixel, error=error, frame=0.5, seed=seed)
        (cell,) = cells_of(film)
        assert cell.pixel == pytest.approx(pixel)
        there.append(seen(cell.film(1.0, 1.0)))
        path, modes = camera.seen(
            plain.path[None], plain.modes[None], np.array([pixel]), np.array([error]), random
        )
        here.append(seen(Films(0.5, path, modes)))
    there, here, ideal = (np.array(values) for values in (there, here, ideal))
    noise = np.hypot(there.std(axis=0), here.std(axis=0)) / np.sqrt(len(here))
    added = np.abs(here - ideal).mean(axis=0)
    away = np.abs((there - here).mean(axis=0)) / (0.33 * added + 3.0 * noise + 1e-9)
    names = np.array([one.name for one in summaries(plain.film(1.0, 1.0))[0]])
    assert (away < 1.0).mean() > 0.97, names[away > 1.0]


def test_a_camera_without_errors_changes_nothing_and_a_fine_one_little():
    one = film()
    random = np.random.default_rng(1)
    none = camera.seen(one.path, one.modes, np.zeros(1), np.zeros(1), random)
    assert none[0] == pytest.approx(one.path)
    assert none[1] is one.modes
    edge = films.equal_arclength(films.edge_of_modes(one.modes, 256))
    even = films.modes_of_edge(edge.real, edge.imag)
    path, modes = camera.seen(one.path, even, np.array([0.02]), np.zeros(1), random)
    assert np.abs(path - one.path).max() < 0.02
    size = np.abs(modes) - np.abs(even)
    assert np.abs(size[..., films.WAVES != 0]).max() < 0.02


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


def test_between_records_a_film_goes_along_cubics_and_reads_none_after_its_last():
    from cellcrawl.infer import microscope

    random = np.random.default_rng(5)
    powers = random.standard_normal((3, 4, 2))  # of t, for three films of two waves
    t = films.SAVE_EVERY * np.arange(30)
    records = np.einsum("fpw,tp->ftw", powers, t[:, None] ** np.arange(4))
    last = np.array([29, 12, 3])
    for film, end in zip(records, last, strict=True):
        film[end + 1 :] = np.nan
    at = random.random((3, 20)) * last[:, None] * films.SAVE_EVERY
    at[:, :2] = np.array([0.0, 1.0]) * (last * films.SAVE_EVERY)[:, None]
    seen = microscope._at(records, at, last)
    true = np.einsum("fpw,ftp->ftw", powers, at[..., None] ** np.arange(4))
    np.testing.assert_allclose(seen, true, rtol=1e-10, atol=1e-9)
