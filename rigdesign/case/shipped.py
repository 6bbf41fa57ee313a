"""Cases that ship with the tool, found by name: in the installed package, or next to it in a checkout."""

from pathlib import Path

from rigdesign.base.errors import UsageError

PACKAGE = Path(__file__).parents[1]
PLACES = (PACKAGE / "cases", PACKAGE.parent / "cases")


def shipped_cases() -> dict[str, Path]:
    """Folder of every shipped case by its name."""
    found = {
        file.parent.name: file.parent
        for place in reversed(PLACES)
        for file in sorted(place.glob("*/case.toml"))
    }
    return dict(sorted(found.items()))


def case_folder(name: str = "uhcf_prototype") -> Path:
    """Folder of a shipped case. Raises UsageError with the names there are."""
    cases = shipped_cases()
    if name not in cases:
        raise UsageError(
            f"no shipped case {name!r}; there are {', '.join(cases) or 'none: install the package again'}"
        )
    return cases[name]
