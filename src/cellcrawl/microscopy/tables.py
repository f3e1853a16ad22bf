"""Plain tables as people save them: any separator, decimal sign, encoding and header lines."""

from __future__ import annotations

import csv
import io
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv

from cellcrawl.errors import InputError
from cellcrawl.microscopy.columns import are_units, recognise

BLANKS = ("", "NA", "N/A", "NaN", "nan", "NAN", "null", "NULL", "None", "none", "-", "#N/A", "?")
_HEAD = 1 << 16  # bytes looked at to find out the form
_SAMPLE = 60  # lines looked at
_BLOCK = 1 << 24  # bytes read at a time
_NUMBER = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*")
_COMMA_NUMBER = re.compile(r"\s*[-+]?\d*,\d+([eE][-+]?\d+)?\s*")
_NUMBER_OR_INFINITE = (
    r"^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$|^[-+]?[iI][nN][fF]([iI][nN][iI][tT][yY])?$"
)
_CLOCK = re.compile(r"\s*-?\d+:\d{1,2}(:\d{1,2}([.,]\d+)?)?\s*|\s*\d{4}-\d\d-\d\d.*")
_SEPARATORS = {",": "comma", ";": "semicolon", "\t": "tab", " ": "blanks", "|": "bar"}


@dataclass(frozen=True)
class Form:
    """How a plain table was written.

    Attributes
    ----------
    names, units : tuple of str
        Names of the columns and what stands below them where a line of units does; empty strings
        for a table without.
    separator, decimal, encoding : str
        The separator of cells, the decimal sign and the encoding.
    first : int
        Number of lines above the first row.
    above : tuple of str
        These lines.
    """

    path: Path
    names: tuple[str, ...]
    units: tuple[str, ...]
    separator: str
    decimal: str
    encoding: str
    first: int
    above: tuple[str, ...]

    @property
    def width(self) -> int:
        """How many columns there are."""
        return len(self.names)

    def __str__(self) -> str:
        told = f"{_SEPARATORS.get(self.separator, self.separator)} between"
        if self.decimal == ",":
            told += ", decimal commas"
        if not self.encoding.startswith("utf-8"):
            told += f", {'Latin-1' if self.encoding == 'cp1252' else self.encoding.upper()}"
        return told


@dataclass(frozen=True)
class Cells:
    """Columns of a table as text, by their place; in pieces, so that no second copy is made."""

    columns: dict[int, pa.ChunkedArray]
    decimal: str
    torn: tuple[int, ...]  # rows with too few or too many cells, counted from 1

    @property
    def rows(self) -> int:
        """How many rows there are."""
        return len(next(iter(self.columns.values())))

    def text(self, place: int) -> pa.ChunkedArray:
        """Return a column as text without blanks around, null where a cell is blank."""
        pieces = [_text(piece) for piece in self.columns[place].chunks]
        return pa.chunked_array(pieces, pa.string())

    def words(self, place: int) -> tuple[np.ndarray, list[str]]:
        """Return which word stands in each row, -1 for a blank, and the words as they appear."""
        return words_of(self.text(place))

    def numbers(self, place: int) -> tuple[np.ndarray, np.ndarray]:
        """Return a column as numbers, NaN where blank; and the rows whose cell is no number."""
        values = np.empty(self.rows)
        bad = [np.empty(0, np.int64)]
        row = 0
        for piece in self.columns[place].chunks:
            part, wrong = _numbers(_text(piece), self.decimal)
            values[row : row + part.size] = part
            bad.append(row + wrong)
            row += part.size
        return values, np.concatenate(bad)


def form_of(path: Path) -> Form:
    """Find out how a plain table was written.

    Raises
    ------
    InputError
        If the file cannot be read or holds no table.
    """
    try:
        encoding, head = _head(path)
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    lines = _lines(head)
    start, given = _given_separator(lines)
    separator, header, first = _layout(path, lines, start, given)
    rows = [_split(line, separator) for line in lines[first : first + _SAMPLE] if line.strip()]
    width = Counter(map(len, rows)).most_common(1)[0][0]
    names, units = _names(lines[start:first], header - start if header >= 0 else -1, separator)
    if names and len(names) == width - 1:  # R's write.table names no column for the row names
        names = ["", *names]
        units = ["", *units]
    names = [*names, *[""] * (width - len(names))][:width]
    units = [*units, *[""] * (width - len(units))][:width]
    decimal = "," if _decimal_comma(rows) else "."
    above = tuple(lines[:first])
    return Form(path, tuple(names), tuple(units), separator, decimal, encoding, first, above)


def read_cells(form: Form, places: Sequence[int]) -> Cells:
    """Read some columns of a table as text, the others not kept, so that long tables fit."""
    path, encoding, separator, first = form.path, form.encoding, form.separator, form.first
    names = [str(place) for place in range(form.width)]
    wanted = [str(place) for place in sorted(set(places))]
    torn: list[int] = []

    def skip(row: pa.csv.InvalidRow) -> str:
        torn.append(int(row.number or 0))
        return "skip"

    source: object = path
    if separator == " " or encoding.startswith("utf-16") or _lone_returns(path):
        text = path.read_bytes().decode(encoding, errors="replace")
        lines = re.split(r"\r\n|\n|\r", text)[first:]
        if separator == " ":
            split = _split_blanks if '"' in text else str.split
            lines = ["\t".join(split(line)) for line in lines]
            separator = "\t"
        source, encoding, first = io.BytesIO("\n".join(lines).encode()), "utf-8", 0
    try:
        read = pa.csv.read_csv(
            source,
            pa.csv.ReadOptions(
                column_names=names,
                skip_rows=first,
                encoding="utf-8" if encoding == "utf-8-sig" else encoding,
                use_threads=False,  # with threads a bad row does not know its number
                block_size=_BLOCK,
            ),
            pa.csv.ParseOptions(delimiter=separator, invalid_row_handler=skip),
            pa.csv.ConvertOptions(
                column_types=dict.fromkeys(names, pa.string()), include_columns=wanted
            ),
        )
    except (pa.ArrowInvalid, OSError) as error:
        told = " ".join(str(error).split())[:160]
        raise InputError(f"{path} cannot be read as a table: {told}") from None
    columns = {int(name): read.column(name) for name in wanted}
    return Cells(columns, form.decimal, tuple(torn))


def words_of(column: pa.ChunkedArray) -> tuple[np.ndarray, list[str]]:
    """Return which word stands in each row, -1 for null, and the words as they appear."""
    encoded = pc.dictionary_encode(column).unify_dictionaries()
    if encoded.num_chunks == 0:
        return np.empty(0, np.int64), []
    places = [
        piece.indices.fill_null(-1).to_numpy(zero_copy_only=False) for piece in encoded.chunks
    ]
    words = [str(word) for word in encoded.chunk(0).dictionary.to_pylist()]
    return np.concatenate(places).astype(np.int64), words


def blocks_of(form: Form) -> np.ndarray:
    """Return the number of the block of each row: blocks have blank lines between them."""
    text = form.path.read_bytes().decode(form.encoding, errors="replace")
    lines = re.split(r"\r\n|\n|\r", text)[form.first :]
    bare = [not line.strip(f'{form.separator} \t"') for line in lines]
    filled = [bool(line.strip()) for line in lines]  # what the parser makes a row of
    begins = np.array([False, *bare[:-1]]) & ~np.array(bare)
    return np.asarray(np.cumsum(begins)[np.array(filled)])


def decoded(data: bytes) -> str:
    """Return text whatever wrote it: UTF-8 or UTF-16 with or without a mark, else Latin-1."""
    return data.decode(_encoding(data), errors="replace")


def clock_seconds(column: pa.ChunkedArray) -> np.ndarray | None:
    """Return times of the form HH:MM:SS, MM:SS or ISO 8601 as seconds; None for others."""
    values = [None if cell is None else cell.strip() for cell in column.to_pylist()]
    filled = [cell for cell in values if cell]
    if not filled or not all(_CLOCK.fullmatch(cell) for cell in filled[:200]):
        return None
    try:
        if "-" in filled[0][1:]:
            stamps = np.array([cell or "NaT" for cell in values], dtype="datetime64[us]")
            seconds = (stamps - np.nanmin(stamps)) / np.timedelta64(1, "s")
            return np.asarray(seconds, float)
        return np.array([_seconds(cell) if cell else np.nan for cell in values])
    except ValueError:
        return None


def _seconds(clock: str) -> float:
    sign = -1.0 if clock.startswith("-") else 1.0
    total = 0.0
    parts = clock.lstrip("-").replace(",", ".").split(":")
    for part in parts:
        total = 60.0 * total + float(part)
    # Two parts are minutes and seconds.
    return sign * total


def _text(piece: pa.Array) -> pa.Array:
    """Return cells without blanks around, null where one is blank."""
    trimmed = pc.utf8_trim_whitespace(piece)
    blank = pc.is_in(trimmed, value_set=pa.array(BLANKS))
    return pc.if_else(blank, pa.scalar(None, pa.string()), trimmed)


def _numbers(text: pa.Array, decimal: str) -> tuple[np.ndarray, np.ndarray]:
    """Return cells as numbers, NaN where blank, and the places of those that are none."""
    if decimal == ",":
        text = pc.replace_substring(text, ",", ".")
    try:
        return _as_floats(text), np.empty(0, np.int64)
    except pa.ArrowInvalid:
        good = pc.fill_null(pc.match_substring_regex(text, _NUMBER_OR_INFINITE), True)
        bad = np.flatnonzero(~good.to_numpy(zero_copy_only=False))
        return _as_floats(pc.if_else(good, text, pa.scalar(None, pa.string()))), bad


def _as_floats(column: pa.Array) -> np.ndarray:
    numbers = pc.cast(column, pa.float64())
    return np.array(pc.fill_null(numbers, np.nan).to_numpy(zero_copy_only=False))


def _encoding(data: bytes) -> str:
    if data.startswith(b"\xef\xbb\xbf"):
        return "utf-8-sig"
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return "utf-16"
    if data[1:2] == b"\x00" and data[3:4] == b"\x00":
        return "utf-16-le"
    try:
        data.decode("utf-8")
    except UnicodeDecodeError as error:
        if error.start < len(data) - 4:  # not merely cut at the end of the sample
            return "cp1252"
    return "utf-8"


def _head(path: Path) -> tuple[str, str]:
    with path.open("rb") as stream:
        data = stream.read(_HEAD)
        whole = len(data) < _HEAD
    if b"\x00" in data and not data.startswith((b"\xff\xfe", b"\xfe\xff")) and data[1:2] != b"\x00":
        raise InputError(f"{path} is not text: it holds no table that can be read")
    encoding = _encoding(data)
    if encoding == "utf-8" and not whole and not _is_utf8(path):
        encoding = "cp1252"  # the odd letter comes late in the file
    text = data.decode(encoding, errors="replace")
    return encoding, text if whole else text[: text.rfind("\n") + 1] or text


def _is_utf8(path: Path) -> bool:
    try:
        with path.open("r", encoding="utf-8", newline="") as stream:
            while stream.read(1 << 22):
                pass
    except UnicodeDecodeError:
        return False
    return True


def _lines(head: str) -> list[str]:
    return [line.rstrip("\r") for line in re.split(r"\r\n|\n|\r", head)]


def _given_separator(lines: Sequence[str]) -> tuple[int, str | None]:
    if lines and re.fullmatch(r'"?sep=(.)"?\s*', lines[0], re.IGNORECASE):
        return 1, re.findall(r"sep=(.)", lines[0], re.IGNORECASE)[0]
    return 0, None


def _split(line: str, separator: str) -> list[str]:
    if separator == " ":
        return next(csv.reader([line.strip()], delimiter=" ", skipinitialspace=True), [])
    return next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])


def _is_value(cell: str) -> bool:
    return bool(_NUMBER.fullmatch(cell) or _COMMA_NUMBER.fullmatch(cell) or _CLOCK.fullmatch(cell))


def _layout(
    path: Path, lines: Sequence[str], start: int, given: str | None
) -> tuple[str, int, int]:
    """Return the separator, the line of the names (-1 without) and the first line of rows."""
    best: tuple[float, str, int, int] | None = None
    for rank, separator in enumerate([given] if given else ["\t", ";", ",", " ", "|"]):
        sample = [
            (number, _split(line, separator))
            for number, line in enumerate(lines[: _SAMPLE + 40])
            if number >= start and line.strip() and not line.startswith(("#", "%"))
        ]
        rows = [(n, cells) for n, cells in sample if sum(map(_is_value, cells)) >= 2]
        if not rows:
            continue
        width = Counter(len(cells) for _, cells in rows).most_common(1)[0][0]
        if width < 2:
            continue
        first = next(n for n, cells in rows if len(cells) == width)
        numbers = [sum(map(_is_value, cells)) for _, cells in rows if len(cells) == width]
        score = len(numbers) / len(sample) * min(width, 4) + float(np.mean(numbers)) / width
        header = _header_line(lines, start, first, separator, width)
        score += 2.0 * (header >= 0) - 0.01 * rank
        if best is None or score > best[0]:
            best = (score, separator, header, first)
    if best is None:
        raise InputError(
            f"{path} holds no table: it needs rows of numbers with commas, semicolons, tabs or "
            "blanks between, below a line of column names"
        )
    return best[1:]


def _header_line(lines: Sequence[str], start: int, first: int, separator: str, width: int) -> int:
    """Return the line above the rows that names the columns best; -1 if none does."""
    found, best = -1, -1
    for number in range(start, first):
        cells = _split(lines[number].lstrip("#%").strip(" "), separator)
        if abs(len(cells) - width) > 1 or not lines[number].strip():
            continue
        roles = recognise([cell.strip() for cell in cells])
        score = 1 + (10 + len(roles.places) if roles is not None else 0)
        if score > best:
            found, best = number, score
    return found


def _names(above: Sequence[str], header: int, separator: str) -> tuple[list[str], list[str]]:
    if header < 0:
        return [], []
    names = [cell.strip() for cell in _split(above[header].lstrip("#%").strip(" "), separator)]
    for line in above[header + 1 :]:
        cells = [cell.strip() for cell in _split(line, separator)]
        filled = [cell for cell in cells if cell]
        bracketed = filled and all(re.fullmatch(r"[\[(].*[\])]", cell) for cell in filled)
        if bracketed or are_units(cells):
            return names, cells
    return names, []


def _decimal_comma(rows: Sequence[Sequence[str]]) -> bool:
    cells = [cell for row in rows for cell in row]
    commas = sum(bool(_COMMA_NUMBER.fullmatch(cell)) for cell in cells)
    points = sum("." in cell and bool(_NUMBER.fullmatch(cell)) for cell in cells)
    return commas > points


def _split_blanks(line: str) -> list[str]:
    return _split(line, " ")


def _lone_returns(path: Path) -> bool:
    """Whether lines end in a carriage return alone, as from an old spreadsheet."""
    with path.open("rb") as stream:
        head = stream.read(_HEAD)
    return b"\n" not in head and b"\r" in head
