"""Linear theory of the resting circle."""

from cellcrawl.linear.theory import BaseState, base_state, fastest_decay, growth_rates

__all__ = ["BaseState", "base_state", "fastest_decay", "growth_rates"]
