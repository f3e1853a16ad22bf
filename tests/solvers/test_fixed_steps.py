import math

import pytest

from cellcrawl.solvers.fixed_steps import slack, steps_towards


@pytest.mark.parametrize("dt", [1e-3, 4e-3, 5e-4, 0.003, 0.0125])
@pytest.mark.parametrize("save_every", [0.1, 0.05, 1.0 / 3.0])
def test_each_saved_time_is_a_step_or_in_the_last_one_however_late(dt, save_every):
    records = [*range(1, 2000), *range(80_000, 82_000), *range(10**6, 10**6 + 2000)]
    for record in records:
        time = record * save_every
        steps = steps_towards(time, math.inf, 0.0, 0, dt)
        before, reached = (steps - 1) * dt, steps * dt
        assert reached >= time - slack(time, dt) > before
        assert abs(time - reached) <= slack(time, dt) or before <= time <= reached
