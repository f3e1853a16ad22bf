"""Which column of a table is what: the names people use for ids, times and positions."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from cellcrawl.errors import InputError, nearest_name
from cellcrawl.validation import shown

ROLES = ("id", "t", "frame", "x", "y", "z", "parent", "group", "unit")

# Normalised names (lower case, letters and digits only), the surest first.
_IDS = (
    *("trackid", "trackno", "tracknumber", "trackindex", "tracknr", "trackn", "tracknum", "tracks"),
    *("track", "trackname", "trackidx", "tracklet", "trackletid", "trajectory", "trajectoryid"),
    *("trajid", "traj", "tid", "particleid", "particle", "particlenumber", "particles", "pid"),
    *("cellid", "celltrack", "cellnumber", "cellno", "cellnr", "cellindex", "cellname", "cell"),
    *("cells", "cellidx", "objectid", "objid", "object", "individualid", "individual", "animalid"),
    *("animal", "subject", "ids", "uid", "id", "identity", "entity", "name", "label", "labels"),
    *("nucleus", "nucleusid", "seriesid", "tracklabel", "objectlabel", "celllabel", "labelid"),
    *("zelle", "zellid", "zellnr", "zellnummer", "spur", "spurid", "cellule", "celula", "piste"),
)
_TIMES = (
    *("positiont", "t", "time", "times", "timestamp", "elapsedtime", "elapsed", "timestamps"),
    *("zeit", "temps", "tiempo", "tempo"),
)
_FRAMES = (
    *("frame", "frames", "frameid", "framenumber", "frameno", "frameindex", "framenr", "framenum"),
    *(
        "framen",
        "imageframe",
        "slice",
        "slicen",
        "slicenumber",
        "sliceno",
        "slicenr",
        "imagenumber",
    ),
    *("image", "imageid", "imageindex", "imageno", "timepoint", "timepoints", "timeindex", "tp"),
    *(
        "timeslice",
        "timestep",
        "timeframe",
        "step",
        "metadataframe",
        "metadatat",
        "metadatatime",
        "ti",
        "tidx",
    ),
    *("metadatatimepoint", "timeidx", "timeid", "timepointid", "framet", "frameidx"),
    *("bild", "bildnr", "bildnummer", "schicht", "fotograma"),
)
_ABSCISSAS = (
    *("x", "positionx", "xposition", "posx", "xpos", "locationcenterx", "areashapecenterx"),
    *("locationx", "xlocation", "locx", "xloc", "centroidx", "xcentroid", "centerx", "xcenter"),
    *("centrex", "xcentre", "centerofmassx", "centreofmassx", "xcoord", "xcoordinate", "coordx"),
    *("coordinatex", "xcoordinates", "pointx", "xc", "cx", "xm", "xt", "spotx", "xum", "xmicron"),
    *("xmicrons", "xpx", "xpixel", "xpixels", "xmm", "xnm", "meanx", "xmean", "cellx", "xcell"),
)
_STEMS = ("locationcenterx", "areashapecenterx", "positionx", "centroidx")
_ROW_COLUMN = (
    *(("col", "row"), ("column", "row"), ("centroid1", "centroid0"), ("cols", "rows")),
    *(("centeroftheobject0", "centeroftheobject1"), ("objectcenter0", "objectcenter1")),
)
_PARENTS = ("parenttrackid", "parentid", "parent", "mother", "motherid", "parenttrack")
_UNITS = ("unit", "units", "positionunit", "lengthunit", "einheit")
_GROUPS = (
    *("movie", "movieid", "video", "videoid", "file", "filename", "well", "wellid", "fov", "site"),
    *("metadatawell", "metadatasite", "metadataplate", "metadatafield", "field", "fieldofview"),
    *("series", "experiment", "experimentid", "replicate", "sample", "sampleid", "dish", "plate"),
    *("scene", "condition", "treatment", "embryo", "movienumber", "source", "dataset", "donor"),
    *("fileid", "sourcename", "repeat", "videoname", "moviename", "metadatafov", "session"),
)
_LENGTHS = {
    "px": "pixel",
    "pixel": "pixel",
    "pixels": "pixel",
    "micron": "µm",
    "microns": "µm",
    "micrometer": "µm",
    "micrometers": "µm",
    "micrometre": "µm",
    "micrometres": "µm",
    "um": "µm",
    "µm": "µm",
    "μm": "µm",
    "nm": "nm",
    "mm": "mm",
    "m": "m",
}
_SPANS = {
    "s": "s",
    "sec": "s",
    "secs": "s",
    "second": "s",
    "seconds": "s",
    "min": "min",
    "mins": "min",
    "minute": "min",
    "minutes": "min",
    "h": "h",
    "hr": "h",
    "hrs": "h",
    "hour": "h",
    "hours": "h",
    "ms": "ms",
    "msec": "ms",
    "d": "d",
    "day": "d",
    "days": "d",
    "frame": "frame",
    "frames": "frame",
}
_BRACKETS = re.compile(r"[\[({]\s*([^\])}]*?)\s*[\])}]")


@dataclass(frozen=True)
class Columns:
    """Which column plays which role: places in the table, and units from their names."""

    places: Mapping[str, int]
    groups: tuple[int, ...] = ()
    length_units: str = ""
    time_units: str = ""
    names: tuple[str, ...] = field(default=(), repr=False)

    def told(self) -> dict[str, str]:
        """Return the names of the columns by role."""
        chosen = {role: self._name(place) for role, place in self.places.items()}
        if self.groups:
            chosen["group"] = ", ".join(self._name(place) for place in self.groups)
        return chosen

    def _name(self, place: int) -> str:
        return self.names[place] or f"column {place + 1}"


def length_unit(text: str) -> str:
    """Return the usual sign of a unit of length, or the text as it is."""
    return _LENGTHS.get(text.strip().lower(), text.strip())


def is_length(text: str) -> bool:
    """Return whether a text is a unit of length that people write."""
    return text.strip().lower() in _LENGTHS


def time_unit(text: str) -> str:
    """Return the usual sign of a unit of time, or the text as it is."""
    return _SPANS.get(text.strip().lower(), text.strip())


def plain(name: str) -> str:
    """Return a column's name as letters and digits only, without its unit."""
    return re.sub(r"[^a-z0-9]", "", _BRACKETS.sub("", name).lower())


def recognise(names: Sequence[str], units: Sequence[str] = ()) -> Columns | None:
    """Return what the columns are by their names, or None if no positions are among them."""
    plains = [plain(name) for name in names]
    places: dict[str, int] = {}
    pair = _positions(plains)
    if pair is None:
        return None
    places["x"], places["y"] = pair
    for role, known in (("id", _IDS), ("frame", _FRAMES), ("parent", _PARENTS), ("unit", _UNITS)):
        found = _first(plains, known, set(places.values()))
        if found is not None:
            places[role] = found
    labels = [i for i, name in enumerate(plains) if re.search(r"trackobjectslabel\d*$", name)]
    if labels:  # CellProfiler counts objects anew in every image; TrackObjects links them
        places["id"] = labels[-1]
    time, unit = _time(plains, set(places.values()))
    if time is not None:
        places["t"] = time
    depth = _depth(plains, plains[places["x"]])
    if depth is not None:
        places["z"] = depth
    groups = tuple(
        i for i, name in enumerate(plains) if name in _GROUPS and i not in places.values()
    )
    where = places["x"]
    length = _unit_of(names[where], units[where] if units else "", _LENGTHS, plains[where])
    if time is not None:
        told = _unit_of(names[time], units[time] if units else "", _SPANS, "")
        unit = told or unit
    return Columns(places, groups, length, unit, tuple(names))


def side_by_side(names: Sequence[str]) -> list[tuple[str, int, int]]:
    """Return the cells of a table that holds them side by side (x1, y1, x2, y2, ...).

    Each is its name and the places of its x and y; none for fewer than two such pairs.
    """
    found = []
    for place, name in enumerate(names):
        for pattern in (r"(x)[ _.-]*(\w+)", r"(\w+?)[ _.-]+(x)"):
            match = re.fullmatch(pattern, name.strip(), re.IGNORECASE)
            if match is None:
                continue
            at = match.start(1 if match[1].lower() == "x" else 2)
            stripped = name.strip()
            other = stripped[:at] + ("Y" if stripped[at] == "X" else "y") + stripped[at + 1 :]
            partner = [i for i, n in enumerate(names) if n.strip() == other]
            if partner:
                cell = match[2] if match[1].lower() == "x" else match[1]
                found.append((cell, place, partner[0]))
                break
    return found if len(found) > 1 else []


def time_column(names: Sequence[str]) -> tuple[int | None, str, str]:
    """Return the place of the times, their role (t or frame) and their unit."""
    plains = [plain(name) for name in names]
    place, unit = _time(plains, set())
    if place is not None:
        return place, "t", _unit_of(names[place], "", _SPANS, "") or unit
    return _first(plains, _FRAMES, set()), "frame", ""


def are_units(cells: Sequence[str]) -> bool:
    """Whether a line of cells holds nothing but units."""
    filled = [cell.strip().lower() for cell in cells if cell.strip()]
    return bool(filled) and all(cell in _LENGTHS or cell in _SPANS for cell in filled)


def chosen(wanted: str | Mapping[str, str | int], names: Sequence[str], width: int) -> Columns:
    """Return the columns a user named.

    Parameters
    ----------
    wanted : str or mapping
        ``"id=Cell,t=Time,x=X,y=Y"`` or the same as a mapping: a role, and the name or the number
        (from 1) of its column; ``id=none`` says that there is one cell. Or roles in the order of
        the columns: ``"id,t,x,y"``, with ``-`` for one to leave out.
    names : sequence of str
        Names of the columns; empty for a table without.
    width : int
        How many columns there are.
    """
    pairs = _pairs(wanted)
    places: dict[str, int] = {}
    groups: list[int] = []
    for role, name in pairs:
        if role not in ROLES:
            raise InputError(f"--columns: no role {role!r}: {nearest_name(role, ROLES)}")
        if role == "id" and str(name).lower() in ("none", ""):
            continue
        place = _place(role, name, names, width)
        if role == "group":
            groups.append(place)
        else:
            places[role] = place
    missing = [role for role in ("x", "y") if role not in places]
    if missing:
        raise InputError(f"--columns must name {' and '.join(missing)} too, as in id=A,t=B,x=C,y=D")
    filled = list(names) or [f"column {number}" for number in range(1, width + 1)]
    length = _unit_of(filled[places["x"]], "", _LENGTHS, plain(filled[places["x"]]))
    time = _unit_of(filled[places["t"]], "", _SPANS, "") if "t" in places else ""
    return Columns(places, tuple(groups), length, time, tuple(filled))


def _pairs(wanted: str | Mapping[str, str | int]) -> list[tuple[str, str | int]]:
    if isinstance(wanted, Mapping):
        return [(str(role), name) for role, name in wanted.items()]
    if not isinstance(wanted, str) or not wanted.strip():
        raise InputError(
            f"columns = {shown(wanted)} must be text such as 'id=Track,t=Time,x=X,y=Y'"
        )
    parts = [part.strip() for part in wanted.split(",")]
    if all("=" in part for part in parts):
        split = [part.partition("=") for part in parts]
        return [(role.strip(), name.strip()) for role, _, name in split]
    if any("=" in part for part in parts):
        raise InputError("--columns: give all roles as role=name, or all in the file's order")
    return [(part, number) for number, part in enumerate(parts, start=1) if part not in ("", "-")]


def _place(role: str, name: str | int, names: Sequence[str], width: int) -> int:
    text = str(name).strip()
    if text in names:
        return list(names).index(text)
    lowered = [other.lower() for other in names]
    if text.lower() in lowered:
        return lowered.index(text.lower())
    if text.isdigit() and 1 <= int(text) <= width:
        return int(text) - 1
    known = f": {nearest_name(text, [n for n in names if n])}" if any(names) else ""
    raise InputError(f"--columns: the file has no column {text!r} for {role}{known}")


def _first(plains: Sequence[str], known: Sequence[str], taken: set[int]) -> int | None:
    for name in known:
        for place, other in enumerate(plains):
            if other == name and place not in taken:
                return place
    return None


def _positions(plains: Sequence[str]) -> tuple[int, int] | None:
    for name in _ABSCISSAS:
        other = _in_y(name)
        if name in plains and other in plains:
            return plains.index(name), plains.index(other)
    for stem in _STEMS:  # CellProfiler's database names begin with the object: Nuclei_Location...
        for place, name in enumerate(plains):
            other = name[:-1] + "y"
            if name.endswith(stem) and other in plains:
                return place, plains.index(other)
    for across, down in _ROW_COLUMN:
        if across in plains and down in plains:
            return plains.index(across), plains.index(down)
    return None


def _in_y(name: str, letter: str = "y") -> str:
    """Return the name that y has where x has this one."""
    return letter + name[1:] if name.startswith("x") else name[:-1] + letter


def _depth(plains: Sequence[str], across: str) -> int | None:
    for name in (_in_y(across, "z"), "z", "positionz"):
        if name in plains:
            return plains.index(name)
    return None


def _time(plains: Sequence[str], taken: set[int]) -> tuple[int | None, str]:
    place = _first(plains, _TIMES, taken)
    if place is not None:
        return place, ""
    pattern = re.compile(rf"(?:t|times?|elapsed|elapsedtime|timestamp)({'|'.join(_SPANS)})")
    for place, name in enumerate(plains):
        found = pattern.fullmatch(name)
        if found and place not in taken:
            return place, _SPANS[found[1]]
    return None, ""


def _unit_of(name: str, below: str, known: Mapping[str, str], suffix_of: str) -> str:
    if below.strip().lower() in known:
        return known[below.strip().lower()]
    for text in (below, name):
        for found in _BRACKETS.findall(text):
            if found.strip().lower() in known:
                return known[found.strip().lower()]
    stem = suffix_of.removeprefix("x")
    if suffix_of.startswith("x") and stem in known:
        return known[stem]
    return ""
