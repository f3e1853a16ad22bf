"""A law of your own.

One formula is replaced: linkers bind faster where others bear a load. Derivatives, the resting
circle, growth rates and compiled code are made from it.
"""

import numpy as np

import cellcrawl as cc


class ForceOnRate(cc.laws.Law):
    """Bonds form faster where others bear a load."""

    source = "an example"
    gain = cc.laws.Parameter(0.1, 0.0, 10.0, "growth of the on-rate with the force on a bond")

    def binding(self, phi, r, n, p):
        """Return the rate of change of the bound fraction at a material point."""
        return p.r_on * (1.0 + self.gain * phi) * (1.0 - n) - r * n


if __name__ == "__main__":
    law, cell = ForceOnRate(gain=0.1), cc.Parameters(r_on=16, zeta_1=560)
    cc.laws.check(law)
    start = cc.RandomPerturbation(seed=4)
    runs = {"the paper's law": None, "a force on the on-rate": law}
    runs = {name: cc.simulate(cell, t_end=50, start=start, laws=one) for name, one in runs.items()}
    cc.plot.paths(runs, every=10).savefig("18_own_law.png", dpi=130)

    # The resting circle by hand: phi = log r_p, and the on-rate is larger by 1 + gain phi.
    faster = cell.r_on * (1 + 0.1 * np.log(cell.r_p))
    rest = cc.laws.rest_state(cell, law)
    print(rest, "by hand", faster / (faster + cell.r_p))
    assert np.isclose(rest.bound_fraction, faster / (faster + cell.r_p))
    # Without gain it is the paper's law.
    none = cc.linear.growth_rates(cell, [1, 2, 3], laws=ForceOnRate(gain=0.0))
    assert np.allclose(none, cc.linear.growth_rates(cell, [1, 2, 3]))
