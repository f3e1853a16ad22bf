"""Sheets of tracks: what is drawn is what was named, and tracks never stop them."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.command_line.main import run
from cellcrawl.microscopy import Track, Tracks
from tests.runs import circling
from tests.tracks import circle_track, sine_track, straight_track


def some_tracks(y_down: bool = False) -> Tracks:
    arrays = [
        straight_track(records=60),
        circle_track(records=200),
        sine_track(records=200, step=0.5),
        straight_track(records=5),
    ]
    return Tracks.of([Track(*track, id=f"cell {i}") for i, track in enumerate(arrays)]).with_source(
        y_down=y_down, length_units="um", time_units="s"
    )


def titles(figure) -> list[str]:
    return [axes.get_title() for axes in figure.axes]


def test_a_sheet_shows_tracks_of_every_mode_and_counts_all():
    figure = cc.plot.tracks(some_tracks(), examples=8)
    shown = [title for title in titles(figure) if title.startswith("cell")]
    assert [title.split()[2] for title in shown] == ["gliding", "rotational", "zigzag"]
    counts = next(axes for axes in figure.axes if "tracks" in axes.get_xlabel())
    names = [label.get_text() for label in counts.get_yticklabels()]
    assert names == ["gliding", "rotational", "zigzag", "not named"]
    assert any("persistence" in title for title in titles(figure))
    figure.canvas.draw()


def test_pictures_are_those_of_the_screen():
    for y_down, sense in ((False, 1.0), (True, -1.0)):
        figure = cc.plot.tracks(some_tracks(y_down)[1:2], examples=1)
        heading = figure.axes[-4].lines[0].get_ydata()
        assert np.sign(heading[-1]) == sense


def test_a_model_and_data_stand_side_by_side():
    figure = cc.plot.compare_tracks({"model": circling(0.4), "data": some_tracks()})
    labels = [part.get_suptitle() for part in figure.subfigs]
    assert labels == ["model: 1 track", "data: 4 tracks"]
    lags = [axes.get_xlabel() for axes in figure.axes if axes.get_xlabel().startswith("lag")]
    assert lags == [r"lag ($1/k_\mathrm{off}^0$)", "lag (s)"]
    figure.canvas.draw()


def test_mistakes_are_one_line():
    with pytest.raises(cc.InputError, match="no tracks to draw"):
        cc.plot.tracks([])
    with pytest.raises(cc.InputError, match="1 results for 4 tracks"):
        cc.plot.tracks(some_tracks(), [None])


@pytest.mark.parametrize("command", ["tracks", "plot"])
def test_a_table_becomes_a_sheet_in_one_command(tmp_path, capsys, command):
    table = tmp_path / "cells.csv"
    t, x, y = circle_track(records=60, step=1.0)
    rows = [f"{k},{a},{b + 9 * k},{c}" for k in range(2) for a, b, c in zip(t, x, y, strict=True)]
    table.write_text("track,t,x,y\n" + "\n".join(rows) + "\n")
    assert run([command, str(table), "--dpi", "40"]) == 0
    said = capsys.readouterr().out
    assert "2 rotational" in said
    assert (tmp_path / "cells-tracks.png").stat().st_size > 1000
    assert run([command, str(tmp_path / "none.csv")]) == 2


def test_outlines_of_one_frame_have_a_sheet_of_their_own(tmp_path, capsys):
    film = cc.observe(circling(0.4, radius=3.0), pixel=0.1)
    file = cc.write_outlines(tmp_path / "c_cp_outlines.txt", film.outlines[:1], pixel=0.1)
    assert run(["tracks", str(file)]) == 0
    said = capsys.readouterr().out
    assert "cellpose" in said
    assert "the sheet is about the outlines" in said
    assert (tmp_path / "c_cp_outlines-tracks.png").stat().st_size > 0
    figure = cc.plot.outlines(film.outlines)
    areas = next(axes for axes in figure.axes if axes.get_xlabel().startswith("area"))
    np.testing.assert_allclose(areas.lines[0].get_xdata(), np.pi, rtol=0.03)
    figure.canvas.draw()
