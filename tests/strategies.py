"""What hypothesis draws from: the ranges of MODEL.md, section 1."""

from hypothesis import strategies as st

import cellcrawl as cc

# The paper's value and the range to support.
TABLE = {
    "r_on": (25, 1, 200),
    "zeta_1": (600, 0, 2000),
    "D": (0.05, 0.001, 1),
    "epsilon": (0.001, 1e-5, 0.1),
    "h": (0.01, 0, 0.2),
    "sigma_c": (100, 0, 1000),
    "k_sigma": (1000, 0, 1e5),
    "r_p": (50, 2, 500),
}


def _values(low: float, high: float) -> st.SearchStrategy[float]:
    """Values from end to end; above 0, none so small that scaling it would lose digits."""
    return st.one_of(st.just(float(low)), st.floats(max(low, 1e-12), high))


parameters = st.builds(
    cc.Parameters,
    **{name: _values(low, high) for name, (_, low, high) in TABLE.items()},
    elasticity=st.sampled_from(["printed", "consistent"]),
)
