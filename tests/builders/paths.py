"""Where the shipped cases are."""

from pathlib import Path

ROOT = Path(__file__).parents[2]
CASES = ROOT / "cases"
