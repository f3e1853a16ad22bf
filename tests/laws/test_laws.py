"""Law sets: their derivatives, their limits, their names, and what is no law."""

from __future__ import annotations

import json
import math
import pickle
import subprocess
import sys

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.laws import (
    CatchSlip,
    Law,
    Parameter,
    PolymerizationUnderLoad,
    Stiffness,
    SweptMyosin,
)
from cellcrawl.laws.law import PAPER, described
from cellcrawl.laws.rest import local_values, rest_state
from cellcrawl.linear.any_law import law_growth_rates

CELL = cc.Parameters(r_on=26, zeta_1=600)
CATCH = CatchSlip(catch=40.0, catch_force=0.8, slip=0.6, slip_force=1.1)
SETS = [
    PAPER,
    CATCH,
    Stiffness(chi=0.4),
    PolymerizationUnderLoad(stall=2000.0, steepness=2.5),
    SweptMyosin(sweep=0.8),
]
AT_NO_STRENGTH = [CatchSlip(), Stiffness(), PolymerizationUnderLoad(), SweptMyosin()]
FORMULAS = ("off_rate", "velocity", "friction", "balance", "binding")


class ForceOnRate(Law):
    """Bonds form faster where others bear a load."""

    gain = Parameter(0.1, 0.0, 10.0, "growth of the on-rate with the force on a bond")

    def binding(self, phi, r, n, p):
        return p.r_on * (1.0 + self.gain * phi) * (1.0 - n) - r * n


def state(law, **changes):
    found = {**local_values(CELL, law), "phi": 2.1, "n": 0.4, "sigma": 700.0, "kappa": 1.7}
    found |= changes
    found["r"] = law.compiled.evaluate("off_rate", found)
    return found


@pytest.mark.parametrize("law", [*SETS, ForceOnRate()], ids=lambda law: law.name)
@pytest.mark.parametrize("by", ["phi", "n", "sigma", "kappa", "pressure", "zeta_1"])
def test_partials_are_those_of_differences(law, by):
    h = 1e-6 * abs(state(law)[by] or 1.0)
    for what in FORMULAS:
        ahead, behind = (
            law.compiled.evaluate(what, state(law, **{by: state(law)[by] + side * h}))
            for side in (1.0, -1.0)
        )
        slope = (ahead - behind) / (2.0 * h)
        made = law.compiled.evaluate(f"{what}/{by}", state(law))
        assert made == pytest.approx(slope, rel=1e-5, abs=1e-6), what


@pytest.mark.parametrize("law", AT_NO_STRENGTH, ids=lambda law: law.name)
def test_at_no_strength_a_law_gives_the_papers_values(law):
    phi, n = np.meshgrid(np.linspace(0.1, 5.0, 20), np.linspace(0.05, 0.9, 20))
    for what in FORMULAS:
        values = state(law, phi=phi, n=n)
        ours, papers = (made.compiled.evaluate(what, values) for made in (law, PAPER))
        np.testing.assert_allclose(ours, papers, rtol=1e-14)


@pytest.mark.parametrize("law", SETS, ids=lambda law: law.name)
def test_growth_rates_are_those_of_a_matrix_of_differences(law):
    # the linear operator at the rest state, by differences of the nonlinear pointwise equations
    rest = rest_state(CELL, law)
    k, h = 3, 1e-6

    def rates(radius, bound):
        values = {
            **local_values(CELL, law),
            "n": rest.bound_fraction + bound,
            "sigma": rest.tension,
            "kappa": 1.0 + (k**2 - 1) * radius,
        }
        phi = rest.bond_force
        for _ in range(50):
            values["phi"] = phi
            values["r"] = law.compiled.evaluate("off_rate", values)
            slope = law.compiled.evaluate("balance/phi", values)
            phi -= law.compiled.evaluate("balance", values) / slope
        velocity = law.compiled.evaluate("velocity", values)
        binding = law.compiled.evaluate("binding", values) - CELL.D * k**2 * bound
        return np.array([velocity, binding])

    columns = [(rates(*(h * e)) - rates(*(-h * e))) / (2.0 * h) for e in np.eye(2)]
    true = np.sort_complex(np.linalg.eigvals(np.array(columns).T))
    made = np.sort_complex(law_growth_rates(CELL, np.array(k), law))
    np.testing.assert_allclose(made, true, rtol=1e-5, atol=1e-6)


def test_the_resting_circle_of_the_papers_law_is_the_closed_one():
    found = cc.laws.rest_states(CELL, CatchSlip())
    assert len(found) == 1
    assert found[0].off_rate == pytest.approx(CELL.r_p, rel=1e-12)
    assert found[0].bound_fraction == pytest.approx(CELL.n_bar, rel=1e-12)
    assert found[0].tension == pytest.approx(CELL.sigma_bar, rel=1e-12)


@pytest.mark.parametrize("law", [*SETS, ForceOnRate()], ids=lambda law: law.name)
def test_what_describes_a_law_makes_it_again(law):
    content = json.loads(json.dumps(law.describe()))
    again = described(content, Law, "law set")
    assert again == law
    assert hash(again) == hash(law)
    copy = pickle.loads(pickle.dumps(law))
    assert copy == law
    assert copy.compiled is law.compiled


def test_a_law_is_named_by_its_formulas_not_by_its_numbers():
    assert Stiffness(chi=0.4).compiled is Stiffness(chi=0.5).compiled
    assert Stiffness(chi=0.4) != Stiffness(chi=0.5)
    assert Stiffness().compiled.digest != PAPER.compiled.digest


def test_laws_that_call_one_number_by_two_names_are_two():
    class Softness(Stiffness):
        give = Parameter(1.0, 0.001, 1.0, "what Stiffness calls chi, after it")

    class Hardness(Stiffness):
        hold = Parameter(1.0, 0.001, 1.0, "what Stiffness calls chi, after it")

    for law in (Softness(chi=0.4), Hardness(chi=0.4)):
        assert law.compiled.rows == law.rows
        assert law.compiled.evaluate("friction", state(law)) > 0.0


def test_a_law_whose_formulas_have_changed_is_told():
    content = {**ForceOnRate().describe(), "formulas": "0" * 16}
    with pytest.raises(cc.InputError, match="its formulas have changed"):
        described(content, Law, "law set")
    content = {**ForceOnRate().describe(), "kind": "no_such_file:Law"}
    with pytest.raises(cc.InputError, match=r"not on this machine: no_such_file\.py"):
        described(content, Law, "law set")


@pytest.mark.parametrize(("name", "kind"), list(cc.laws.SHIPPED.items()))
def test_shipped_laws_have_names_sources_and_a_line_on_each_number(name, kind):
    assert cc.laws.as_law(name) == kind()
    assert kind.source
    assert kind.__doc__
    assert all(parameter.meaning for parameter in kind.parameters.values())
    cc.laws.check(kind(), CELL)


class Wild(Law):
    """No unique root where few linkers are bound."""

    def off_rate(self, phi, p):
        return 300.0 * cc.laws.exp(-2.0 * phi) + 0.1 * cc.laws.exp(phi)


class Unknown(Law):
    """Uses what it does not have."""

    def friction(self, phi, r, n, p):
        return phi * (r + p.glue * n)


class Branching(Law):
    """Chooses by if."""

    def binding(self, phi, r, n, p):
        return p.r_on if phi > 1.0 else 0.0


class Infinite(Law):
    """Not finite at no force."""

    def binding(self, phi, r, n, p):
        return p.r_on * (1.0 - n) - r * n + 1.0 / phi


class Immovable(Law):
    """Flows nowhere."""

    def retrograde_velocity(self, phi, r, p):
        return 0.0 * phi


@pytest.mark.parametrize(
    ("law", "told"),
    [
        (Wild, "no unique root"),
        (Unknown, "'glue' that it does not have"),
        (Branching, "where"),
        (Infinite, "not finite at phi = 0"),
        (Immovable, "no resting circle"),
    ],
)
def test_what_is_no_law_is_told_in_one_line(law, told):
    with pytest.raises(cc.InputError, match=told) as refused, np.errstate(all="ignore"):
        cc.laws.check(law(), cc.Parameters(r_p=20))
    assert "\n" not in str(refused.value)


def test_swept_myosin_is_refused_where_its_root_is_not_unique():
    limit = CELL.v_p / CELL.sigma_c
    assert math.isclose(limit, 1.956, abs_tol=1e-3)
    with pytest.raises(cc.InputError, match=r"below v_p / sigma_c = 1\.956"):
        cc.simulate(CELL, 0.1, laws=SweptMyosin(sweep=limit))


@pytest.mark.parametrize("laws", ["catchslip", 3, object, "math:pi", "no_such_module:Law", [PAPER]])
def test_what_is_no_law_is_refused(laws):
    with pytest.raises(cc.InputError) as refused:
        cc.simulate(CELL, 0.1, laws=laws)
    assert "\n" not in str(refused.value)


def test_eigenmodes_know_the_papers_law_only():
    with pytest.raises(cc.InputError, match="Eigenmode"):
        cc.simulate(CELL, 0.1, start=cc.Eigenmode(k=2), laws=Stiffness(chi=0.5))


def test_a_law_of_a_script_is_found_by_the_workers_of_its_sweep_and_by_its_name(tmp_path):
    script = tmp_path / "glued.py"
    script.write_text(
        "import cellcrawl as cc\n"
        "class Glued(cc.laws.Law):\n"
        "    gain = cc.laws.Parameter(0.5, 0.0, 1.0, 'of the binding')\n"
        "    def binding(self, phi, r, n, p):\n"
        "        return (1.0 + self.gain) * p.r_on * (1.0 - n) - r * n\n"
        "if __name__ == '__main__':\n"
        "    print(Glued().describe()['kind'])\n"
        "    from cellcrawl.sweeps.executors import _see_that_workers_know\n"
        "    _see_that_workers_know(cc.Grid(axes={'r_on': [20.0]}, laws=Glued()))\n"
        "    from cellcrawl.laws.law import described\n"
        "    assert described(Glued().describe(), cc.laws.Law, 'law set') == Glued()\n"
    )
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["glued:Glued"]
