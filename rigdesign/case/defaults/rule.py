"""Rules that know a value for a key a case leaves out.

    @default("gearboxes.*.gears.*.material")
    def _material(tree: RawTree, box: str, gear: str) -> Given | None:
        return assumed("case_hardened_steel", "usual for gears")

A rule is asked once for every place its path fits, ``*`` standing for the names of the case, and only where the key is
missing. Rules are asked in the order in which they are written, so that one may build on what another has filled in.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from rigdesign.base import units
from rigdesign.case.provenance import is_marked

if TYPE_CHECKING:
    from dynamics.rotor.rolling_kinds import CatalogueBearing

# Values of a case file before it is validated, without source, assumption and range; None where unreadable.


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


BY_THE_TOOL = "default of the tool: "
"""How the reason of every value starts that the case does not state."""


@dataclass(frozen=True, kw_only=True)
class Given:
    """A value in place of a key that is missing.

    value : as a case would write it
    reason : why, in one line
    range : lowest and highest plausible value; none for a name, a choice or a setting of the solver
    is_assumption : False where it follows from the rest of the case and nothing is assumed
    """

    value: Any
    reason: str
    range: tuple[Any, Any] | None = None
    is_assumption: bool = True

    def as_marked(self) -> dict[str, Any]:
        """The value with its marks."""
        text = BY_THE_TOOL + self.reason
        marked = {"value": self.value, "assumed" if self.is_assumption else "source": text}
        return marked if self.range is None else {**marked, "range": list(self.range)}


Filling: TypeAlias = "Given | Mapping[str, Any] | list[Any] | None"
"""A value, a table or list of such values, or None where the rule knows none."""


@dataclass(frozen=True)
class DefaultRule:
    """One rule and the path it is for.

    within : start of the path down to a table that the case has to state; empty where the rule makes its tables
    completes : of a table of named parts, parts are added to those that are stated; not where one of these has
        an unknown name, so that a misspelt one stays a fault
    """

    path: str
    known: Callable[..., Filling]
    within: str = ""
    completes: bool = False


def assumed(value: Any, reason: str, low: Any = None, high: Any = None) -> Given:
    """An assumption of the tool, with its range where it has one."""
    return Given(value=value, reason=reason, range=None if low is None else (low, high))


def follows(value: Any, reason: str) -> Given:
    """A name or measure that follows from the rest of the case."""
    return Given(value=value, reason=reason, is_assumption=False)


def around(value: float, unit: str, reason: str, spread: tuple[float, float] = (0.5, 2.0)) -> Given:
    """An assumed quantity in ``unit`` with a range of ``spread`` times its value; three digits."""
    low, high = (f"{value * factor:.3g} {unit}" for factor in spread)
    return assumed(f"{value:.3g} {unit}", reason, low, high)


def millimetres(length: float) -> str:
    """A length [m] as a case would write it."""
    return f"{1e3 * length:.6g} mm"


class RuleBook:
    """Rules of one topic in their order.

    within : start of all paths down to a table without which none of the rules applies
    """

    def __init__(self, within: str = "") -> None:
        self.rules: list[DefaultRule] = []
        self.within = within

    def default(
        self, path: str, *, completes: bool = False
    ) -> Callable[[Callable[..., Filling]], Callable[..., Filling]]:
        """Enters a function as the rule of a path."""

        def enter(known: Callable[..., Filling]) -> Callable[..., Filling]:
            self.rules.append(DefaultRule(path, known, self.within, completes))
            return known

        return enter


def fill(tree: RawTree, rule: DefaultRule) -> None:
    """Fill the places of one rule that are missing, in place."""
    for names in list(_places(tree, rule.path.split("."), ())):
        keys = _with_names(rule.path, names)
        depth = len(rule.within.split(".")) if rule.within else 0
        if depth and not tree.has(".".join(keys[:depth])):
            continue
        if rule.completes and tree.has(".".join(keys)):
            _complete(tree.at(".".join(keys)), _known(rule, tree, names))
        elif not tree.has(".".join(keys)) and (found := _known(rule, tree, names)) is not None:
            _insert(tree.root, keys, with_marks(found))


def _known(rule: DefaultRule, tree: RawTree, names: tuple[str, ...]) -> Filling:
    """What a rule knows: nothing where a stated value is so far beyond its limits that no number follows from it."""
    try:
        return rule.known(tree, *names)
    except OverflowError:
        return None


def _complete(stated: Any, found: Filling) -> None:
    """Add parts to a table that states some of them, in place."""
    if isinstance(stated, dict) and isinstance(found, Mapping) and set(stated) < set(found):
        for name, part in found.items():
            stated.setdefault(name, with_marks(part))


def _places(tree: RawTree, keys: list[str], names: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    """What the stars of a path stand for, for every place it fits."""
    if "*" not in keys:
        yield names
        return
    star = keys.index("*")
    for name in tree.names(".".join(keys[:star])):
        yield from _places(tree, [*keys[:star], name, *keys[star + 1 :]], (*names, name))


def _with_names(path: str, names: tuple[str, ...]) -> list[str]:
    left = iter(names)
    return [next(left) if key == "*" else key for key in path.split(".")]


def _insert(root: dict[str, Any], keys: list[str], value: Any) -> None:
    """Put a value at its place; tables on the way are made. Nothing happens where one is no table."""
    node: Any = root
    for key in keys[:-1]:
        if not isinstance(node, dict) or is_marked(node):
            return
        node = node.setdefault(key, {})
    if isinstance(node, dict) and not is_marked(node) and keys[-1] not in node:
        node[keys[-1]] = value


def with_marks(found: Any) -> Any:
    """What a rule fills in as the tree of a case holds it."""
    if isinstance(found, Given):
        return found.as_marked()
    if isinstance(found, Mapping):
        return {key: with_marks(value) for key, value in found.items() if value is not None}
    return [with_marks(item) for item in found] if isinstance(found, list) else found


# What defaults need to know of the parts of a gearbox before it is validated: pairs, diameters, distances.


def shaft_of(tree: RawTree, box: str, kind: str, part: str) -> str | None:
    """Shaft of a gear, a bearing or seals."""
    return tree.text(f"gearboxes.{box}.{kind}.{part}.shaft")


def shafts_of(tree: RawTree, box: str) -> list[str]:
    """Shafts of the gears of a gearbox, each once."""
    found = (shaft_of(tree, box, "gears", gear) for gear in tree.names(f"gearboxes.{box}.gears"))
    return list(dict.fromkeys(shaft for shaft in found if shaft is not None))


def gear_on(tree: RawTree, box: str, shaft: str) -> str | None:
    """First gear on a shaft."""
    gears = tree.names(f"gearboxes.{box}.gears")
    return next((gear for gear in gears if shaft_of(tree, box, "gears", gear) == shaft), None)


def only_mesh(tree: RawTree, box: str) -> str | None:
    """The mesh of a gearbox that has one; None for any other."""
    meshes = tree.names(f"gearboxes.{box}.meshes")
    return meshes[0] if len(meshes) == 1 else None


def mesh_of(tree: RawTree, box: str, gear: str) -> str | None:
    """First mesh that a gear is in."""
    for mesh in tree.names(f"gearboxes.{box}.meshes"):
        at = f"gearboxes.{box}.meshes.{mesh}"
        if gear in (tree.text(f"{at}.pinion"), tree.text(f"{at}.wheel")):
            return mesh
    return None


def normal_module(tree: RawTree, box: str, gear: str) -> float | None:
    """Normal module of a gear [m]."""
    mesh = mesh_of(tree, box, gear)
    return None if mesh is None else tree.length(f"gearboxes.{box}.meshes.{mesh}.normal_module")


def root_diameter(tree: RawTree, box: str, gear: str) -> float | None:
    """Root circle [m] of rack A of ISO 53, without profile shift where the gear states none."""
    mesh, at = mesh_of(tree, box, gear), f"gearboxes.{box}.gears.{gear}"
    module, teeth = normal_module(tree, box, gear), tree.number(f"{at}.teeth")
    if mesh is None or module is None or teeth is None:
        return None
    helix = tree.si(f"gearboxes.{box}.meshes.{mesh}.helix_angle", "angle") or 0.0
    shift = tree.number(f"{at}.profile_shift") or 0.0
    return module * (teeth / math.cos(helix) + 2.0 * shift - 2.5)


def bearings_on(tree: RawTree, box: str, shaft: str) -> list[str]:
    """Bearings of a shaft by name."""
    bearings = tree.names(f"gearboxes.{box}.bearings")
    return [name for name in bearings if shaft_of(tree, box, "bearings", name) == shaft]


def tabled(tree: RawTree, box: str, bearing: str) -> "CatalogueBearing | None":
    """The rolling bearing of the catalogue that a bearing names; None for any other."""
    designation = tree.text(f"gearboxes.{box}.bearings.{bearing}.designation")
    if designation is None:
        return None
    from dynamics.rotor.bearing import BearingError
    from dynamics.rotor.rolling_catalogue import catalogue_bearing

    try:
        return catalogue_bearing(designation)
    except BearingError:
        return None


def bearing_bore(tree: RawTree, box: str, bearing: str) -> float | None:
    """Journal or bore of a bearing [m]: stated, or that of its designation."""
    at = f"gearboxes.{box}.bearings.{bearing}"
    found = tabled(tree, box, bearing)
    if found is not None:
        return found.bore
    stated = tree.length(f"{at}.diameter")
    return tree.length(f"{at}.catalogue.bore") if stated is None else stated


def bearing_width(tree: RawTree, box: str, bearing: str) -> float | None:
    """Width of a bearing [m]: stated, or that of its designation."""
    at = f"gearboxes.{box}.bearings.{bearing}"
    found = tabled(tree, box, bearing)
    if found is not None:
        return found.width
    stated = tree.length(f"{at}.width")
    return tree.length(f"{at}.catalogue.width") if stated is None else stated


def shaft_diameter(tree: RawTree, box: str, shaft: str) -> float | None:
    """Diameter of a shaft in its bearings [m], the smaller one where they differ."""
    return min(bearing_bores(tree, box, shaft), default=None)


def bearing_bores(tree: RawTree, box: str, shaft: str) -> list[float]:
    """Known bores of the bearings of a shaft [m]."""
    bores = (bearing_bore(tree, box, name) for name in bearings_on(tree, box, shaft))
    return [bore for bore in bores if bore is not None]


def section_diameter(tree: RawTree, shaft: str, position: float | None) -> float | None:
    """Outside diameter [m] of a stated shaft at a place; None where no section is stated there."""
    at, end = f"drivetrain.shafts.{shaft}.sections", 0.0
    for index in range(tree.count(at)):
        length = tree.length(f"{at}.{index}.length")
        if position is None or length is None:
            return None
        end += length
        if position <= end:
            return tree.length(f"{at}.{index}.outer_diameter")
    return None


def inner_length(tree: RawTree, box: str) -> float | None:
    """Length between the end walls of a housing [m]."""
    at = f"gearboxes.{box}.housing"
    chamber = tree.length(f"{at}.warm_length")
    if chamber is None:
        return None
    front, rear = tree.length(f"{at}.cold_length_front"), tree.length(f"{at}.cold_length_rear")
    partition = tree.length(f"{at}.partition_thickness")
    return chamber + (front or 0.0) + (rear or 0.0) + 2.0 * (partition or 0.0)


def bearing_distance(tree: RawTree, box: str, shaft: str) -> float | None:
    """Distance of the two bearings of a shaft [m]: at the inner side of the end walls; three diameters beside the gear
    in a gearbox without a housing."""
    if tree.has(f"gearboxes.{box}.housing"):
        inner = inner_length(tree, box)
        found = (bearing_width(tree, box, name) for name in bearings_on(tree, box, shaft))
        widths = [width for width in found if width is not None]
        return None if inner is None or not widths else inner + sum(widths) / len(widths)
    gear, diameter = gear_on(tree, box, shaft), shaft_diameter(tree, box, shaft)
    face = None if gear is None else tree.length(f"gearboxes.{box}.gears.{gear}.face_width")
    return None if face is None or diameter is None else face + 3.0 * diameter
