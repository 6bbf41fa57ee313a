"""The case file: what a user states about a rig.

    rigdesign.case.load_case(path) -> Case

``model`` is the table of contents; ``gears``, ``gearbox``, ``housing``, ``drivetrain``, ``schedule``,
``losses``, ``limits``, ``numerics`` and ``substances`` hold its parts. ``source`` reads files, ``marks``
takes off what a value says about itself, ``rules`` gathers what spans several keys (``*_rules``,
``surfaces``), ``faults`` words what is wrong.
"""

from rigdesign.case.loader import load_case
from rigdesign.case.model import Case
from rigdesign.case.schema import json_schema

__all__ = ["Case", "json_schema", "load_case"]
