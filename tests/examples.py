"""How many examples Hypothesis makes: few in the suite, where they are always the same, more where it searches for others."""

from hypothesis import HealthCheck, settings

_MORE = 5


def examples(count: int) -> settings:
    """Return settings for so many examples, or for five times as many with the profile `random`."""
    many = count if settings().derandomize else _MORE * count
    return settings(max_examples=many, deadline=None, suppress_health_check=[HealthCheck.too_slow])
