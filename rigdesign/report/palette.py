"""The colours of page and figures: one list for both, told apart without red and green as well.

A second coding stands with every colour: line style and marker in figures, a word in badges.
"""

INK = "#22303c"
GRID = "#d9dfe4"
MUTED = "#7d8b97"
SERIES = ("#1f5a8a", "#c2571a", "#3c7a4b", "#7a4c93", "#9a7b1c", "#2a8c8c", "#a3395b", "#5b6b78")
VERDICT_COLOURS = {"pass": "#2e7d4f", "warn": "#b7791f", "fail": "#b3261e", "not applicable": "#8a96a1"}
