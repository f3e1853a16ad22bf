"""`cellcrawl dispersion` and `cellcrawl stability`: linear theory of the resting circle."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click
import numpy as np

from cellcrawl.command_line.look import Look, look_options
from cellcrawl.command_line.options import cannot_write, parameter_options, save_picture, say
from cellcrawl.errors import InputError
from cellcrawl.parameters import DESCRIPTIONS, Parameters
from cellcrawl.validation import known_names, shown

if TYPE_CHECKING:
    import xarray as xr

F = TypeVar("F", bound=Callable[..., Any])

_USUAL = Parameters()
_PLANE = ("r_on=5:70", "zeta_1=400:640")
_MOST_VALUES = 5000


def _picture_options(function: F) -> F:
    output = click.option(
        "--output",
        type=click.Path(path_type=Path),
        metavar="PICTURE",
        help="Draw it too (.png, .pdf, .svg).",
    )
    dpi = click.option(
        "--dpi",
        type=click.IntRange(30, 1200),
        default=200,
        show_default=True,
        help="Resolution of a .png.",
    )
    return output(dpi(look_options(function)))


@click.command()
@click.option(
    "--vary",
    multiple=True,
    metavar="NAME=VALUES",
    help="Several values of one parameter, as in zeta_1=400,500,600 or zeta_1=400:600:5.",
)
@click.option(
    "--k-max",
    type=click.IntRange(2, 1000),
    metavar="NUMBER",
    help="Highest wavenumber.  [default: 20 in the table, enough to see all decay in the picture]",
)
@_picture_options
@parameter_options(_USUAL)
def dispersion(
    vary: tuple[str, ...],
    k_max: int | None,
    output: Path | None,
    dpi: int,
    look: Look,
    **parameters: Any,
) -> None:
    """Print both growth rates of every wavenumber; with --output, draw them.

    k = 0 breathes, k = 1 moves the cell, k >= 2 change its shape. Where the roots are a complex
    pair, the mode oscillates as it grows or decays. Rates are in units of k_off0.

    \b
    Examples
      cellcrawl dispersion
      cellcrawl dispersion --r-on 20 --D 0.01 --vary zeta_1=400,500,600 --output dispersion.pdf
      cellcrawl dispersion --elasticity consistent --k-max 5
    """
    from cellcrawl import plot

    cell = _cell(parameters)
    varied = _varied(vary)
    if len(varied) > 1:
        raise InputError("--vary takes one parameter here: `cellcrawl stability` takes two")
    name, values = next(iter(varied.items()), ("r_on", np.array([cell.r_on])))
    cells = [cell.replace(**{name: float(value)}) for value in values]
    for index, member in enumerate(cells):
        if index:
            say("")
        _print_rates(member, 20 if k_max is None else k_max)
    if output is not None:
        family: dict[str, Any] = dict(varied)
        with look.used():
            save_picture(plot.dispersion(cell, k_max=k_max, **family), output, dpi)


@click.command()
@click.option(
    "--vary",
    multiple=True,
    default=_PLANE,
    show_default=" and ".join(_PLANE),
    metavar="NAME=LOW:HIGH",
    help="A parameter and its range; give it twice, the horizontal axis first. NAME=LOW:HIGH:COUNT "
    "and NAME=V1,V2,... say which values the map has.",
)
@click.option(
    "--k",
    "wavenumbers",
    default="1,2,5,10,15",
    show_default=True,
    metavar="NUMBERS",
    help="Wavenumbers, 0 for the breathing mode.",
)
@click.option(
    "--data",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write the map too (.nc).",
)
@_picture_options
@parameter_options(_USUAL)
def stability(
    vary: tuple[str, ...],
    wavenumbers: str,
    data: Path | None,
    output: Path | None,
    dpi: int,
    look: Look,
    **parameters: Any,
) -> None:
    """Say which wavenumbers grow where, over two parameters; with --output, draw the map.

    \b
    Examples
      cellcrawl stability --output stability.pdf
      cellcrawl stability --vary r_on=5:70 --vary sigma_c=0:300 --zeta-1 500 --k 1,2,3
      cellcrawl stability --k 0 --elasticity consistent
      cellcrawl stability --data map.nc
    """
    from cellcrawl import linear, plot
    from cellcrawl.plot.style import figure_of

    cell = _cell(parameters)
    stability_map = linear.stability_map(
        cell, k=_numbers("--k", wavenumbers.split(",")), **_varied(vary)
    )
    _print_map(stability_map)
    if data is not None:
        if data.suffix != ".nc":
            raise InputError(f"--data {shown(str(data))} must end in .nc")
        try:
            stability_map.to_netcdf(data, engine="h5netcdf")
        except OSError as error:
            raise cannot_write(data, error) from None
        say(f"data     {data}")
    if output is not None:
        with look.used():
            save_picture(figure_of(plot.stability(stability_map)), output, dpi)


def _cell(parameters: dict[str, Any]) -> Parameters:
    return _USUAL.replace(
        **{name: value for name, value in parameters.items() if value is not None}
    )


def _varied(texts: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Read ``NAME=V1,V2`` and ``NAME=LOW:HIGH:COUNT``."""
    varied: dict[str, np.ndarray] = {}
    for text in texts:
        name, equals, values = text.partition("=")
        name = name.strip().replace("-", "_")
        if not equals:
            raise InputError(
                f"--vary {shown(text)} must be a name and values, as in zeta_1=400,500,600"
            )
        known_names("--vary", [name], DESCRIPTIONS)
        if name in varied:
            raise InputError(f"--vary has {name} twice")
        varied[name] = _values(name, values)
    return varied


def _values(name: str, text: str) -> np.ndarray:
    parts = text.split(":")
    if len(parts) == 1:
        return _numbers(f"--vary {name}", text.split(","))
    numbers = _numbers(f"--vary {name}", parts)
    count = numbers[2] if len(numbers) == 3 else 201
    if len(numbers) > 3 or count != int(count) or not 2 <= count <= _MOST_VALUES:
        raise InputError(
            f"--vary {name}={text} must be LOW:HIGH or LOW:HIGH:COUNT, COUNT 2 to {_MOST_VALUES}"
        )
    return np.linspace(numbers[0], numbers[1], int(count))


def _numbers(what: str, parts: list[str]) -> np.ndarray:
    try:
        return np.array([float(part) for part in parts])
    except ValueError:
        raise InputError(f"{what} must be numbers, not {shown(','.join(parts))}") from None


def _print_rates(cell: Parameters, k_max: int) -> None:
    from cellcrawl import linear

    say(
        f"cell     r_on = {cell.r_on:g}, zeta_1 = {cell.zeta_1:g}, D = {cell.D:g}, "
        f"sigma_c = {cell.sigma_c:g}, {cell.elasticity} tension law"
    )
    say(f"{'k':>8} {'larger root':>20} {'smaller root':>20}")
    for k, (larger, smaller) in enumerate(linear.growth_rates(cell, np.arange(k_max + 1))):
        say(f"{k:>8} {_shown(larger):>20} {_shown(smaller):>20}")
    say(f"unstable {_summary(cell)}")
    for kind, transitions in (
        ("onset", linear.oscillation_onset(cell, k=(1.0, k_max))),
        ("Hopf", linear.hopf_points(cell, k=(1.0, k_max))),
    ):
        for t in transitions:
            what = (
                f"real roots {'become' if t.rising else 'end'} a complex pair"
                if kind == "onset"
                else f"a pair crosses the axis, frequency {t.frequency:.4g}"
            )
            say(f"{kind:8} k = {t.value:.4f}: {what}")


def _summary(cell: Parameters) -> str:
    from cellcrawl import linear

    try:
        unstable = linear.unstable_modes(cell)
        fastest = linear.fastest_mode(cell)
    except InputError as error:
        return str(error)
    if fastest is None:
        return "none"
    shown = f"k = {unstable[0]}" + (f" to {unstable[-1]}" if unstable.size > 1 else "")
    return f"{shown}, fastest k = {fastest.k} at a rate of {fastest.growth_rate:.4g}"


def _shown(root: complex) -> str:
    if root.imag == 0.0:
        return f"{root.real:.5g}"
    return f"{root.real:.5g} {'+' if root.imag > 0.0 else '-'} {abs(root.imag):.5g}i"


def _print_map(stability_map: xr.Dataset) -> None:
    from cellcrawl import linear

    _, first, second = (str(dim) for dim in stability_map["growth_rate"].dims)
    x, y = stability_map[first].values, stability_map[second].values
    say(f"map      {first} {x[0]:g} to {x[-1]:g}, {second} {y[0]:g} to {y[-1]:g}")
    say(f"{'k':>8} {'unstable':>10} {'curves':>8}   least {second} on the marginal curves")
    for k in stability_map["k"].values:
        grows = stability_map["growth_rate"].sel(k=k).values > 0.0
        curves = linear.curves_in(stability_map, k)
        least = "-"
        if curves:
            vertices = np.concatenate(curves)
            low_x, low_y = vertices[np.argmin(vertices[:, 1])]
            least = f"{low_y:.4g} at {first} = {low_x:.4g}"
        say(f"{k:>8} {100.0 * grows.mean():>9.1f}% {len(curves):>8}   {least}")
