"""`cite`: what to name in a paper that uses a run or a result."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any, Final

import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.citing.references import REFERENCES, Reference
from cellcrawl.citing.uses import ANALYSES, LAWS, LINE, MODEL, SOLVERS
from cellcrawl.data import decode_attribute
from cellcrawl.errors import InputError
from cellcrawl.validation import shown

_TITLE: Final = "cellcrawl: simulate how single cells crawl"
_ON_A_LINE: Final = ("two edges", "flat edge")
_OF_THIS_PACKAGE: Final = "cellcrawl."


@dataclass(frozen=True)
class Citation:
    """A paper and what it stands behind."""

    reference: Reference
    why: str


@dataclass(frozen=True)
class Citations:
    """The software and the papers to cite; prints as a list of references.

    Attributes
    ----------
    versions : tuple of str
        Versions of cellcrawl that made what was given.
    papers : tuple of Citation
        Papers, the model first, each once.
    others : tuple of str
        Sources named by laws and surroundings that are not part of this package, as they stand.
    """

    versions: tuple[str, ...]
    papers: tuple[Citation, ...]
    others: tuple[str, ...] = ()

    def text(self) -> str:
        """Return the list of references, a line each, with what each is cited for."""
        software = f"The cellcrawl developers. {_TITLE}. Version {' and '.join(self.versions)}."
        lines = [f"{software} [the software]"]
        lines += [f"{paper.reference.text()} [{paper.why}]" for paper in self.papers]
        return "\n".join([*lines, *self.others])

    def bibtex(self) -> str:
        """Return the entries for BibTeX; sources of laws of your own stand in comments."""
        software = "\n".join(
            [
                "@software{cellcrawl,",
                "  author = {{The cellcrawl developers}},",
                f"  title = {{{{{_TITLE}}}}},",
                f"  version = {{{' and '.join(self.versions)}}},",
                "}",
            ]
        )
        entries = [software, *(paper.reference.bibtex() for paper in self.papers)]
        return "\n\n".join([*entries, *(f"% {line}" for line in self.others)])

    def __str__(self) -> str:
        return self.text()


@checked
def cite(*used: Any) -> Citations:
    """Say what to cite for runs and results, or for the package alone.

    Parameters
    ----------
    *used : Dataset, Sweep, Law, Surrounding, PersistentWalk, ShapeModes, Fit or LyapunovExponent
        Runs, of which laws, surroundings and solver are named; runs on a line; sweeps; laws and
        surroundings by themselves; results of fits, also of groups, comparisons and choices.
        None: the software and its model.

    Returns
    -------
    Citations
        Prints as a list; ``.bibtex()`` for BibTeX.

    Raises
    ------
    InputError
        For anything that names no method of this package.

    See Also
    --------
    cellcrawl.open_run : Open the file of a run.

    Examples
    --------
    >>> print(cite().papers[0].reference.key)
    chen2023
    """
    reasons: dict[str, list[str]] = {}
    others: list[str] = []
    versions: list[str] = []
    for key, why in MODEL:
        reasons.setdefault(key, []).append(why)
    for one in used:
        for key, why in _behind(one, others, versions):
            if why not in reasons.setdefault(key, []):
                reasons[key].append(why)
    return Citations(
        versions=tuple(dict.fromkeys(versions)) or (version("cellcrawl"),),
        papers=tuple(Citation(REFERENCES[key], "; ".join(why)) for key, why in reasons.items()),
        others=tuple(dict.fromkeys(others)),
    )


def _behind(used: Any, others: list[str], versions: list[str]) -> Iterator[tuple[str, str]]:
    from cellcrawl.laws import Law
    from cellcrawl.surroundings import Surrounding
    from cellcrawl.sweeps import Sweep

    if isinstance(used, xr.Dataset):
        yield from _behind_a_run(used, others, versions)
    elif isinstance(used, Law | Surrounding):
        yield from _behind_parts([used.describe()], others)
    elif isinstance(used, Sweep):
        shared = used.grid.describe()["run"]
        world = [shared.get("laws"), *(shared.get("surroundings") or [])]
        yield from _behind_parts([part for part in world if part], others)
        columns = used.table(["solver"]).to_pydict()["solver"]
        for solver in dict.fromkeys(columns):
            yield from SOLVERS.get(solver, ())
    elif type(used).__name__ in ANALYSES and type(used).__module__.startswith(_OF_THIS_PACKAGE):
        yield from ANALYSES[type(used).__name__]
    else:
        raise InputError(
            f"there is nothing to cite for {shown(used)}: give runs, sweeps, laws, surroundings, "
            "or results of persistent_walk, shape_modes, infer.fit or branches.lyapunov_exponent"
        )


def _behind_a_run(
    run: xr.Dataset, others: list[str], versions: list[str]
) -> Iterator[tuple[str, str]]:
    if "solver" not in run.attrs:
        if run.attrs.get("model") in _ON_A_LINE:
            yield from LINE
            return
        raise InputError("this dataset has no attribute 'solver': is it a cellcrawl run?")
    versions.append(str(run.attrs.get("cellcrawl_version", version("cellcrawl"))))
    parts: list[Any] = []
    if "laws" in run.attrs:
        parts.append(decode_attribute(run, "laws"))
    if "surroundings" in run.attrs:
        parts.extend(decode_attribute(run, "surroundings"))
    yield from _behind_parts(parts, others)
    yield from SOLVERS.get(str(run.attrs["solver"]), ())


def _behind_parts(parts: Iterable[Any], others: list[str]) -> Iterator[tuple[str, str]]:
    """Yield what stands behind described laws and surroundings; note those of other people."""
    for part in parts:
        module, _, name = str(part["kind"]).partition(":")
        if module.startswith(_OF_THIS_PACKAGE):
            if name in LAWS:
                yield LAWS[name]
        else:
            others.append(f"{name}, a law or surrounding of your own: {_own_source(module, name)}")


def _own_source(module: str, name: str) -> str:
    """Return the source that a class names, if the class is loaded."""
    found = getattr(sys.modules.get(module), name, None)
    own = vars(found).get("source", "") if isinstance(found, type) else ""
    return str(own) or "it names no source"
