"""The report of a fit: one HTML file, with its pictures inside, that needs no network."""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from cellcrawl.arguments import checked, file_path
from cellcrawl.errors import InputError, StorageError
from cellcrawl.infer import pictures
from cellcrawl.infer.population import Comparison, Group
from cellcrawl.infer.result import Fit
from cellcrawl.validation import shown

_DPI: Final = 160
_STYLE: Final = """
:root{color-scheme:light dark;--ink:#222;--soft:#666;--line:#ddd;--paper:#fff;--warn:#8a1c1c}
@media(prefers-color-scheme:dark){:root{--ink:#e8e8e8;--soft:#aaa;--line:#444;--paper:#181818;
--warn:#ff9c8f}}
*{box-sizing:border-box}
body{margin:0 auto;padding:1.2rem 1rem 3rem;max-width:62rem;color:var(--ink);
background:var(--paper);font:16px/1.5 system-ui,sans-serif;overflow-wrap:anywhere}
h1{font-size:1.5rem;margin:.2rem 0}h2{font-size:1.15rem;margin:2rem 0 .4rem}
h3{font-size:1rem;margin:1.2rem 0 .4rem}
details{border-bottom:1px solid var(--line);padding:.4rem 0}summary{cursor:pointer}
p.sub{color:var(--soft);margin:.2rem 0}
.wide{overflow-x:auto}
table{border-collapse:collapse;width:100%}
th,td{text-align:left;padding:.35rem .7rem .35rem 0;border-bottom:1px solid var(--line);
vertical-align:top}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
td:first-child{min-width:8rem;overflow-wrap:normal}
td small{color:var(--soft);display:block}
@media(max-width:600px){td,th{font-size:.8rem;padding-right:.4rem;overflow-wrap:normal}
td.n,th.n{white-space:normal}
td:first-child{min-width:5.6rem}.row img{width:100%}}
img{max-width:100%;height:auto;background:#fff;border-radius:4px}
.row{display:flex;flex-wrap:wrap;gap:.6rem}.row img{width:18rem}
.alone{width:24rem}.corner{min-width:34rem;width:46rem}
ul.told{padding-left:1.2rem}ul.told li{margin:.3rem 0}
.alarm{border-left:4px solid var(--warn);padding:.4rem .8rem;color:var(--warn)}
pre{white-space:pre-wrap;border:1px solid var(--line);padding:.6rem;border-radius:4px}
"""


@checked
def report(
    fits: Sequence[Fit],
    output: str | Path,
    *,
    command: str = "",
    comparison: Comparison | None = None,
    group: Group | None = None,
    title: str = "",
) -> Path:
    """Write one HTML file about fits: pictures, numbers, caveats and what makes it again.

    Parameters
    ----------
    fits : sequence of Fit
        One or several; each gets its part of the page.
    output : str or Path
        The file, ``.html``.
    command : str
        What makes the page again, printed at its end.
    comparison : Comparison, optional
        Of two conditions, told first.
    group : Group, optional
        Of the cells together, told next.
    title : str
        Heading of the page.

    Raises
    ------
    InputError
        For no fits, or a name that is not of an HTML page.
    StorageError
        If it cannot be written.
    """
    cells = list(fits)
    for one in cells:
        if not isinstance(one, Fit):
            raise InputError(f"fits must be what fit or fit_all returns, not {shown(one)}")
    if not cells:
        raise InputError("there is no fit to report")
    path = must_be_a_page(output)
    heading = title or ("What a cell says" if len(cells) == 1 else f"What {len(cells)} cells say")
    parts = [f"<h1>{_text(heading)}</h1>", _origin(cells[0])]
    if comparison is not None:
        parts.append(_of_comparison(comparison))
    if group is not None:
        parts.append(_of_group(group))
    if len(cells) == 1:
        parts += ["<h2>What the film says</h2>", _of_fit(cells[0])]
        pairs = _image(pictures.corner(cells[0]), "pairs of parameters", "corner")
        parts.append(f'<h2>Pairs of parameters</h2><div class="wide">{pairs}</div>')
    else:
        parts.append("<h2>Cell by cell</h2>")
        parts += [_folded(fit, comparison) for fit in cells]
    parts.append(_of_method(cells[0], command))
    text = (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>{_text(heading)}</title><style>{_STYLE}</style></head><body>"
        + "\n".join(parts)
        + "</body></html>\n"
    )
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise StorageError(
            f"cannot write {path}: {error.strerror or error}; give another output"
        ) from None
    return path


def must_be_a_page(output: str | Path) -> Path:
    """Return the file of a report, or refuse a name that is not of an HTML page."""
    path = file_path("output", output)
    if path.suffix.lower() not in (".html", ".htm"):
        raise InputError(f"{path}: a report is written as .html")
    return path


def _origin(fit: Fit) -> str:
    bank = fit.trained.bank
    return (
        f'<p class="sub">The model of Chen, Saintillan &amp; Rangamani (2023), law '
        f"{_text(type(bank.law).__name__)}; {len(bank)} runs of {_text(bank.path.name)}, hash "
        f"{_text(bank.digest)}.</p>"
    )


def _folded(fit: Fit, comparison: Comparison | None) -> str:
    """Return a line of one cell of several, which opens."""
    name = f"Cell {fit.cell.name}"
    if comparison is not None:
        name += ", control" if fit in comparison.control.fits else ", treated"
    found = [f"{row['name']} {row['value']:.3g}" for row in fit.table()]
    told = "the model makes no such film" if fit.alarm else ", ".join(found)
    return (
        f"<details><summary><b>{_text(name)}</b>: {_text(told)}</summary>{_of_fit(fit)}</details>"
    )


def _of_fit(fit: Fit) -> str:
    parts = []
    if fit.alarm:
        parts.append(
            '<p class="alarm">The model makes no such film: do not believe the intervals below '
            f"(alarm {fit.strangeness:.2f}, above 1).</p>"
        )
    parts.append(_table(fit))
    parts.append(
        '<div class="row">'
        + "".join(
            _image(pictures.margin_picture(fit, name), f"posterior of {name}") for name in fit.names
        )
        + '</div><p class="sub">Each posterior over its prior (dashed); median, and interval of '
        "90 % shaded.</p>"
    )
    if fit.caveats:
        items = "".join(f"<li>{_text(one[0].upper() + one[1:])}.</li>" for one in fit.caveats)
        parts.append(f'<h3>What to know</h3><ul class="told">{items}</ul>')
    made = [] if fit.alarm else pictures.foretold(fit)
    films = [("the cell", fit.cell), *((one.name, one) for one in made)]
    parts.append("<h3>The film, and runs with such parameters</h3>")
    size = "corner" if made else "alone"
    shown_films = _image(pictures.cell_picture(films), "the film and runs", size)
    parts.append(f'<div class="wide">{shown_films}</div>')
    return "\n".join(parts)


def _table(fit: Fit) -> str:
    rows = []
    for row in fit.table():
        told = row["of the prior"]
        part = "" if np.isnan(told) else f"{told:.0%}"
        unit = f" {row['unit']}" if row["unit"] else ""
        bounds = f"{row['low']:.4g} to {row['high']:.4g}"
        rows.append(
            f"<tr><td>{_text(row['name'])}<small>{_text(row['meaning'])}</small></td>"
            f'<td class="n">{row["value"]:.4g}{unit}</td>'
            f'<td class="n">{bounds}</td><td class="n">{part}</td></tr>'
        )
    return (
        '<div class="wide"><table><tr><th>parameter</th><th class="n">median</th>'
        '<th class="n">90 % between</th><th class="n">of the prior</th></tr>'
        + "".join(rows)
        + '</table></div><p class="sub">"Of the prior": spread of the posterior over that of the '
        "prior; 100 % says that the film tells nothing.</p>"
    )


def _of_comparison(comparison: Comparison) -> str:
    rows = []
    for i, name in enumerate(comparison.names):
        found = comparison.factor(name)
        rows.append(
            f'<tr><td>{_text(name)}</td><td class="n">×&nbsp;{found.value:.3f}</td>'
            f'<td class="n">{found.low:.3f} to {found.high:.3f}</td>'
            f'<td class="n">{comparison.rises[i]:.3f}</td>'
            f'<td class="n">{comparison.moved[i]:.3f}</td></tr>'
        )
    counts = f"{len(comparison.control.fits)} cells, then {len(comparison.treated.fits)}"
    return (
        f"<h2>What changed</h2><p>If one parameter moved, it is <b>{_text(comparison.likeliest)}"
        f"</b>, with probability {comparison.moved.max():.2f} ({counts}).</p>"
        '<div class="wide"><table><tr><th>parameter</th><th class="n">factor</th>'
        '<th class="n">90 % between</th><th class="n">P(rose)</th>'
        '<th class="n">P(it alone)</th></tr>'
        + "".join(rows)
        + "</table></div>"
        + '<div class="wide">'
        + _image(pictures.comparison_picture(comparison), "cells of both conditions", "corner")
        + "</div>"
    )


def _of_group(group: Group) -> str:
    items = "".join(f"<li>{_text(one)}</li>" for one in group.lines()[1:])
    return f'<h2>{len(group.fits)} cells together</h2><ul class="told">{items}</ul>'


def _of_method(fit: Fit, command: str) -> str:
    calibration = fit.calibration
    cells = len(calibration.rank)
    outcomes = ", ".join(f"{n} {c}" for n, c in fit.trained.view.outcomes.items() if c)
    made = f"<h2>This page again</h2><pre>{_text(command)}</pre>" if command else ""
    return (
        "<h2>Whether to trust it</h2>"
        f"<p>The same fit of {cells} cells of the bank that nothing was trained on, filmed as this "
        "one: what was found over what is true, the ranks of the truth in the posterior (even if "
        "the method is right), and how often intervals hold the truth.</p>"
        f'<div class="wide">'
        f"{_image(pictures.calibration_picture(calibration), 'calibration', 'corner')}</div>"
        f'<p class="sub">Looks at the bank: {_text(outcomes)}. Resting cells and runs that tore or '
        "left the model's range before the end of the film are not compared with: this cell moved "
        "and lived.</p>" + made
    )


def _image(figure: Any, alt: str, kind: str = "") -> str:
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=_DPI)
    data = base64.b64encode(stream.getvalue()).decode()
    style = f' class="{kind}"' if kind else ""
    return f'<img{style} alt="{_text(alt)}" src="data:image/png;base64,{data}">'


def _text(value: str) -> str:
    return html.escape(value)
