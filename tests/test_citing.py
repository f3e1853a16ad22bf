"""What a run used is what is cited, each paper once, in forms that references managers read."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.citing import REFERENCES
from cellcrawl.citing.uses import ANALYSES, LAWS, LINE, MODEL, SOLVERS
from cellcrawl.command_line.main import run
from cellcrawl.laws import SHIPPED


class Stickier(cc.laws.Law):
    source = "a first try"

    def binding(self, phi, r, n, p):
        return 1.1 * p.r_on * (1.0 - n) - r * n


def keys(found):
    return [paper.reference.key for paper in found.papers]


def made(**attributes):
    """A run's attributes; what is cited hangs on nothing else."""
    short = cc.one_dimensional.simulate_two_edges(cc.Parameters(), 0.02)
    short.attrs = {"solver": "adaptive", "cellcrawl_version": "0.1.0", **attributes}
    return short


def test_the_model_is_always_cited_first():
    assert keys(cc.cite())[0] == "chen2023"
    assert keys(cc.cite(made()))[0] == "chen2023"


def test_a_run_names_its_laws_surroundings_and_solver():
    ground = cc.surroundings.TensionGradient(mu=1.0)
    soft = cc.laws.Stiffness(chi=0.9)
    one = cc.simulate(
        cc.Parameters(r_on=26), 0.01, save_every=0.01, start=cc.PerturbedCircle(),
        laws=soft, surroundings=ground, solver="paper", nodes=64,
    )  # fmt: skip
    assert {"chan2008", "lieber2015", "hou1994"} <= set(keys(cc.cite(one)))
    assert keys(cc.cite(soft, ground)) == ["chen2023", "bell1978", "chan2008", "lieber2015"]


@pytest.mark.parametrize("name", SHIPPED)
def test_every_shipped_law_has_its_paper_with_the_year_that_it_names(name):
    law = SHIPPED[name]()
    (key, _) = LAWS[type(law).__name__]
    assert key in keys(cc.cite(law))
    if name != "paper":
        assert str(REFERENCES[key].year) in law.source


def test_each_paper_is_named_once_with_all_that_it_is_for():
    found = cc.cite(made(), made(solver="paper"), made(solver="spline"))
    assert len(keys(found)) == len(set(keys(found)))
    assert "the model; the published scheme" in found.text()
    assert found.versions == ("0.1.0",)


def test_a_law_of_ones_own_is_told_by_the_source_it_names():
    assert "Stickier" in cc.cite(Stickier()).others[0]
    assert "a first try" in cc.cite(Stickier()).text()
    assert "% Stickier" in cc.cite(Stickier()).bibtex()


def test_analyses_and_the_line_are_cited():
    t = [0.1 * i for i in range(60)]
    walk = cc.observables.persistent_walk(t, [x**1.1 for x in t], [x**0.9 for x in t])
    assert "johnson2008" in keys(cc.cite(walk))
    growth = cc.branches.LyapunovExponent(0.1, 0.01, "chaotic", 9.0, np.zeros(18))
    assert "benettin1980" in keys(cc.cite(growth))
    assert "sens2020" in keys(cc.cite(cc.one_dimensional.simulate_two_edges(cc.Parameters(), 0.02)))


def test_every_paper_stands_behind_something_and_every_analysis_is_a_public_class():
    behind = [*MODEL, *LAWS.values(), *LINE]
    behind += [pair for pairs in (*SOLVERS.values(), *ANALYSES.values()) for pair in pairs]
    assert {key for key, _ in behind} == set(REFERENCES)
    for name in ANALYSES:
        assert any(hasattr(part, name) for part in (cc.observables, cc.infer, cc.branches)), name


def test_the_page_lists_every_paper_with_its_address():
    page = (Path(__file__).parent.parent / "docs" / "citing.md").read_text("utf-8")
    for reference in REFERENCES.values():
        assert f"{reference.pages} ({reference.year}). [{reference.doi}](https://doi.org/" in page


def test_a_sweep_names_what_its_runs_used(tmp_path):
    shared = {"laws": cc.laws.Stiffness(chi=0.9), "t_end": 0.01, "save_every": 0.01}
    grid = {"r_on": [26], "start": [cc.PerturbedCircle()]}
    sweep = cc.sweep(grid, tmp_path / "one", workers=1, solver="paper", nodes=64, **shared)
    assert {"chan2008", "hou1994"} <= set(keys(cc.cite(sweep)))


def test_bibtex_is_well_formed():
    entries = "\n\n".join(reference.bibtex() for reference in REFERENCES.values())
    assert entries.count("{") == entries.count("}")
    assert len(re.findall(r"^@\w+\{\w+,$", entries, re.M)) == len(REFERENCES)
    for reference in REFERENCES.values():
        assert re.fullmatch(r"10\.\d{4,9}/\S+", reference.doi)
        assert str(reference.year) in reference.key


def test_what_names_no_method_is_refused():
    with pytest.raises(cc.InputError, match="nothing to cite"):
        cc.cite(3.0)


def test_the_command_prints_a_list_and_bibtex(capsys):
    assert run(["cite"]) == 0
    assert "10.1103/PRXLife.1.023007" in capsys.readouterr().out
    assert run(["cite", "--bibtex"]) == 0
    assert capsys.readouterr().out.startswith("@software{cellcrawl,")
    assert run(["cite", "nowhere.nc"]) == 2
