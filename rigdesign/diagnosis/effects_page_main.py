"""Print the page of effects: `python -m rigdesign.diagnosis.catalogue CASE ... > cases/effects.md`."""

import sys
from pathlib import Path

from rigdesign.case import load_case
from rigdesign.diagnosis.effects_page import effects_page

if __name__ == "__main__":
    sys.stdout.write(effects_page([load_case(Path(name)) for name in sys.argv[1:]]))
