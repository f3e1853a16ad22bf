"""Outlines written as the files that segmentation programs read."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from itertools import pairwise
from os import PathLike
from pathlib import Path
from typing import Any, Final

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError, StorageError
from cellcrawl.microscopy.extras import reader
from cellcrawl.microscopy.label_images import FEWEST_PIXELS
from cellcrawl.microscopy.outlines import Outline
from cellcrawl.microscopy.raster import rasterised
from cellcrawl.microscopy.track_forms import write_text
from cellcrawl.microscopy.trackmate_model import trackmate_model
from cellcrawl.validation import one_of, real_number

OUTLINE_FORMS: Final = (
    *("label tiff", "cell tracking challenge", "cellpose masks", "cellpose outlines"),
    *("imagej roi", "geojson", "celltool", "trackmate"),
)
"""Forms in which `write_outlines` writes."""


@checked
def write_outlines(
    path: str | PathLike[str],
    outlines: Iterable[Outline],
    *,
    form: str | None = None,
    pixel: float | None = None,
) -> Path:
    """Write outlines in the form of a segmentation program.

    Parameters
    ----------
    path : path-like
        The file; a folder for "cell tracking challenge" and for several outlines as "celltool".
    outlines : Outlines or iterable of Outline
    form : str, optional
        One of `OUTLINE_FORMS`; by the name of ``path`` unless given: .tif a label image,
        ``_seg.npy`` cellpose masks, .txt cellpose outlines, .roi or .zip ImageJ, .geojson, .contour
        Celltool, .xml TrackMate.
    pixel : float, optional
        Size of a pixel in the outlines' unit of length; 1 unless given. All forms but TrackMate's
        hold pixels.

    Returns
    -------
    Path
        Of the file or folder.

    Notes
    -----
    Label images start at the origin, and what lies at negative coordinates is refused, as is a cell
    of fewer than four pixels, which no reader takes for one. cellpose outlines are rounded to whole
    pixels. Outlines with y upwards are mirrored, as tracks are.
    """
    target = Path(path)
    form = form or _by_name(target)
    one_of("form", form, OUTLINE_FORMS)
    given = list(outlines)
    if not given:
        raise InputError("there are no outlines to write")
    size = 1.0 if pixel is None else real_number("pixel", pixel, 0.0, 1e12, open_low=True)
    drawn = [_downwards(one) / size for one in given]
    try:
        if form in ("label tiff", "cellpose masks", "cell tracking challenge"):
            _write_labels(target, form, given, drawn, size)
        elif form == "cellpose outlines":
            write_text(target, "".join(_cellpose_line(xy) for xy in drawn))
        elif form == "imagej roi":
            _write_rois(target, given, drawn)
        elif form == "geojson":
            write_text(target, json.dumps(_geojson(given, drawn)))
        elif form == "celltool":
            _write_celltool(target, given, drawn, pixel)
        else:
            write_text(target, _trackmate(given))
    except OSError as error:
        raise StorageError(f"cannot write {target}: {error.strerror or error}") from None
    return target


def write_label_tiff(
    target: Path, labels: np.ndarray, pixel: float, frame: float, length: str, time: str
) -> None:
    """Write labels (frame, row, column) as an ImageJ hyperstack with pixel size and interval."""
    tifffile = reader("tifffile", "label TIFFs")
    told: dict[str, Any] = {"axes": "TYX", "unit": _ascii(length or "pixel"), "finterval": frame}
    if time:
        told["tunit"] = _ascii(time)
    tifffile.imwrite(
        target,
        labels,
        imagej=True,
        resolution=(1.0 / pixel, 1.0 / pixel),
        metadata=told,
        compression="zlib",
    )


def _ascii(unit: str) -> str:
    """Return a unit as ImageJ keeps it: a micro sign is its escape."""
    escaped = unit.replace("\N{MICRO SIGN}", r"\u00B5").replace(
        "\N{GREEK SMALL LETTER MU}", r"\u00B5"
    )
    return escaped.encode("ascii", "backslashreplace").decode()


def _by_name(target: Path) -> str:
    if target.name.endswith("_seg.npy"):
        return "cellpose masks"
    known = {
        ".tif": "label tiff",
        ".tiff": "label tiff",
        ".txt": "cellpose outlines",
        ".roi": "imagej roi",
        ".zip": "imagej roi",
        ".geojson": "geojson",
        ".json": "geojson",
        ".contour": "celltool",
        ".xml": "trackmate",
    }
    if target.suffix.lower() not in known:
        raise InputError(f"the name {target.name} tells no form: give form=, such as 'label tiff'")
    return known[target.suffix.lower()]


def _downwards(outline: Outline) -> np.ndarray:
    return outline.xy if outline.y_down else outline.xy * np.array([1.0, -1.0])


def _numbers(outlines: Sequence[Outline]) -> dict[str, int]:
    names = list(dict.fromkeys(one.track for one in outlines))
    if all(name.isascii() and name.isdigit() and int(name) > 0 for name in names):
        return {name: int(name) for name in names}
    return {name: number for number, name in enumerate(names, start=1)}


def _write_labels(
    target: Path, form: str, outlines: Sequence[Outline], drawn: Sequence[np.ndarray], size: float
) -> None:
    numbers = _numbers(outlines)
    low = min(float(xy.min()) for xy in drawn)
    if low < -0.5:
        raise InputError(
            f"an outline reaches {low:.4g} pixels: shift them to positive coordinates first"
        )
    columns = int(max(xy[:, 0].max() for xy in drawn)) + 3
    rows = int(max(xy[:, 1].max() for xy in drawn)) + 3
    frames = max(one.frame for one in outlines) + 1
    kind = np.uint8 if max(numbers.values()) < 256 else np.uint16
    if max(numbers.values()) > 65535:
        raise InputError("more than 65 535 cells do not fit into one label image")
    labels = np.zeros((frames, rows, columns), kind)
    for one, xy in zip(outlines, drawn, strict=True):
        covered = rasterised(xy, (rows, columns))
        if np.count_nonzero(covered) < FEWEST_PIXELS:
            raise InputError(
                f"the outline of {one.track or 'the cell'} in frame {one.frame} covers "
                f"{np.count_nonzero(covered)} pixels of {size:g}: give a smaller pixel"
            )
        labels[one.frame][covered] = numbers[one.track]
    first = outlines[0]
    if form == "cellpose masks":
        content = {"masks": labels[0] if frames == 1 else labels, "filename": target.name}
        np.save(target, np.array(content, dtype=object), allow_pickle=True)
    elif form == "label tiff":
        interval = _interval(outlines)
        write_label_tiff(target, labels, size, interval, first.length_units, first.time_units)
    else:
        _write_challenge(target, outlines, labels.astype(np.uint16), numbers)


def _interval(outlines: Sequence[Outline]) -> float:
    apart = [
        (other.t - one.t) / (other.frame - one.frame)
        for one, other in pairwise(outlines)
        if one.track == other.track and other.frame > one.frame
    ]
    return float(np.median(apart)) if apart else 1.0


def _write_challenge(
    folder: Path, outlines: Sequence[Outline], labels: np.ndarray, numbers: dict[str, int]
) -> None:
    tifffile = reader("tifffile", "folders of the Cell Tracking Challenge")
    folder.mkdir(parents=True, exist_ok=True)
    digits = max(3, len(str(len(labels) - 1)))
    for frame, image in enumerate(labels):
        tifffile.imwrite(folder / f"mask{frame:0{digits}d}.tif", image, compression="zlib")
    rows = []
    for name, number in numbers.items():
        frames = [one.frame for one in outlines if one.track == name]
        rows.append(f"{number} {min(frames)} {max(frames)} 0\n")
    write_text(folder / "res_track.txt", "".join(rows))


def _cellpose_line(xy: np.ndarray) -> str:
    whole = np.round(xy).astype(int).ravel()
    return ",".join(map(str, whole)) + "\n"


def _write_rois(target: Path, outlines: Sequence[Outline], drawn: Sequence[np.ndarray]) -> None:
    roifile = reader("roifile", "ImageJ regions of interest")
    if target.suffix.lower() == ".roi" and len(outlines) > 1:
        raise InputError("a .roi file holds one region: give a name that ends in .zip")
    target.unlink(missing_ok=True)
    regions = []
    for one, xy in zip(outlines, drawn, strict=True):
        region = roifile.ImagejRoi.frompoints(xy, name=one.track or None)
        region.roitype = roifile.ROI_TYPE.POLYGON
        region.t_position = one.frame + 1
        region.position = one.frame + 1
        regions.append(region)
    if target.suffix.lower() == ".roi":
        regions[0].tofile(target)
    else:
        names = [f"{one.track}-{one.frame:04d}.roi" for one in outlines]
        roifile.roiwrite(target, regions, name=names)


def _geojson(outlines: Sequence[Outline], drawn: Sequence[np.ndarray]) -> dict[str, Any]:
    return {
        "type": "FeatureCollection",
        "features": [
            {
                "type": "Feature",
                "geometry": {"type": "Polygon", "coordinates": [[*xy.tolist(), xy[0].tolist()]]},
                "properties": {"track": one.track, "frame": one.frame},
            }
            for one, xy in zip(outlines, drawn, strict=True)
        ],
    }


def _write_celltool(
    target: Path,
    outlines: Sequence[Outline],
    drawn: Sequence[np.ndarray],
    pixel: float | None,
) -> None:
    units = (outlines[0].length_units if pixel is None else "") or "px"
    if len(outlines) == 1:
        write_text(target, _celltool(drawn[0], units))
        return
    target.mkdir(parents=True, exist_ok=True)
    for one, xy in zip(outlines, drawn, strict=True):
        name = f"{one.track.replace('/', '-') or 'cell'}-{one.frame:04d}.contour"
        write_text(target / name, _celltool(xy, units))


def _celltool(xy: np.ndarray, units: str) -> str:
    points = ",\n       ".join(f"[{x:.8f}, {y:.8f}]" for x, y in xy)
    return (
        'cls = ("celltool.contour.contour_class", "Contour")\n'
        f"units = \\\n'{units}'\n\npoints = \\\narray([{points}])\n"
    )


def _trackmate(outlines: Sequence[Outline]) -> str:
    spots: list[dict[str, Any]] = []
    links: dict[str, list[int]] = {}
    numbers = _numbers(outlines)
    for one in sorted(outlines, key=lambda one: (one.track, one.frame)):
        x, y = one.centroid * (1.0, 1.0 if one.y_down else -1.0)
        around = _downwards(one) - (x, y)
        text = " ".join(format(value, ".12g") for value in around.ravel())
        links.setdefault(str(numbers[one.track]), []).append(len(spots))
        radius = math.sqrt(one.area / math.pi)
        spots.append(
            {"x": x, "y": y, "t": one.t, "frame": one.frame, "text": text, "radius": radius}
        )
    return trackmate_model(spots, links, outlines[0].length_units, outlines[0].time_units)
