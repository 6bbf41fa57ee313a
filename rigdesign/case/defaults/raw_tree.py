"""Values of a case file before it is validated, without source, assumption and range; None where unreadable."""

import math
from collections.abc import Mapping
from typing import Any

from rigdesign.base import units
from rigdesign.case.provenance import is_marked


def unmarked(node: Any) -> Any:
    """A value without its marks; what stands inside it keeps them."""
    return node["value"] if is_marked(node) else node


class RawTree:
    """The tree of a case file, read by dotted path. A rule that finds None where it needs a number knows no default."""

    def __init__(self, root: dict[str, Any]) -> None:
        self.root = root

    def at(self, path: str) -> Any:
        """What stands at a path, without marks; None where there is nothing."""
        node: Any = self.root
        for key in path.split("."):
            node = unmarked(node)
            if isinstance(node, list | tuple) and key.isdigit() and int(key) < len(node):
                node = node[int(key)]
            elif isinstance(node, Mapping):
                node = node.get(key)
            else:
                return None
        return unmarked(node)

    def has(self, path: str) -> bool:
        """Whether anything stands at a path."""
        return self.at(path) is not None

    def names(self, path: str) -> list[str]:
        """Keys of a table; none where there is no table."""
        node = self.at(path)
        return [key for key in node if isinstance(key, str)] if isinstance(node, Mapping) else []

    def count(self, path: str) -> int:
        """Entries of a list; none where there is no list."""
        node = self.at(path)
        return len(node) if isinstance(node, list | tuple) else 0

    def text(self, path: str) -> str | None:
        """A text."""
        node = self.at(path)
        return node if isinstance(node, str) else None

    def number(self, path: str) -> float | None:
        """A bare number that is finite."""
        node = self.at(path)
        if not isinstance(node, int | float) or isinstance(node, bool) or not abs(node) < math.inf:
            return None
        return float(node)

    def si(self, path: str, kind: str) -> float | None:
        """A quantity in SI units; None for one that is missing or cannot be read."""
        try:
            return units.parse(self.at(path), kind)
        except units.QuantityError:
            return None

    def length(self, path: str) -> float | None:
        """A length [m]."""
        return self.si(path, "length")
