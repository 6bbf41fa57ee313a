"""API Std 617, 8th ed. 2014, part 1, and API TR 684-1: critical speeds, logarithmic decrement, amplitudes.

Applied here to test rigs, which have no standard of their own. AF: amplification factor at a critical speed; SM:
separation margin as a share of the operating speed.
"""

AF_CRITICAL = 2.5
"""Below it a response is critically damped and needs no separation margin."""
LEAST_DECREMENT = 0.1
"""Of a rotor in its bearings."""
MOST_CLEARANCE_SHARE = 0.75
"""Peak-to-peak amplitude over the diametral running clearance."""
TORSIONAL_SEPARATION = 0.10
"""Distance of undamped torsional frequencies from excitation frequencies."""


def separation_below(AF: float) -> float:
    """SM of a critical speed below the operating speed, 17 (1 - 1 / (AF - 1.5)) % [-]."""
    return 0.0 if AF < AF_CRITICAL else 0.17 * (1.0 - 1.0 / (AF - 1.5))


def separation_above(AF: float) -> float:
    """SM of a critical speed above it, 10 % + 17 (1 - 1 / (AF - 1.5)) % [-]."""
    return 0.0 if AF < AF_CRITICAL else 0.10 + 0.17 * (1.0 - 1.0 / (AF - 1.5))
