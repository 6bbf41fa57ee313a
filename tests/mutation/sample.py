"""Mutants of the three packages: places in their code, and what cosmic-ray puts there instead.

A module is drawn by its length, a place in it evenly, then one of the operators that fit the place. Places that a run
cannot answer for are left out: annotations, decorators, texts.
"""

import ast
import random
import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from cosmic_ray import plugins
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from parso.tree import NodeOrLeaf

from tests.builders.paths import ROOT

PACKAGES = ("rigdesign", "thermal", "dynamics")
ARITHMETIC = "(Add_Sub|Sub_Add|Mul_Div|Div_Mul|Mul_Add|Pow_Mul)"
ORDER = "(Eq|NotEq|Lt|LtE|Gt|GtE)"
OPERATORS = re.compile(
    f"core/(ReplaceBinaryOperator_{ARITHMETIC}|ReplaceComparisonOperator_{ORDER}_{ORDER}"
    "|ReplaceUnaryOperator_(USub_UAdd|Delete_USub|Delete_Not)|AddNot|ReplaceTrueWithFalse|ReplaceFalseWithTrue"
    "|ReplaceAndWithOr|ReplaceOrWithAnd|ReplaceBreakWithContinue|ReplaceContinueWithBreak|NumberReplacer"
    "|ZeroIterationForLoop)"
)
"""What an engineer could have written by mistake; not what Python refuses at once, as shifts of floats."""
BINARY_PARENTS = ("arith_expr", "term", "power")
"""Elsewhere ``*`` and ``**`` unpack."""
LARGEST = 1e3
"""Of a constant that is moved by one: more of it would not be seen in any result."""
DRAWING = re.compile(r"rigdesign/report/(figures/\w+|pages/views)\.py")
"""Line widths and places on paper: looked at, not computed with."""


@dataclass(frozen=True, kw_only=True)
class Mutant:
    """One change of one module; ``lines`` are those of the statement it is in."""

    module: str
    operator: str
    occurrence: int
    lines: tuple[int, int]

    @property
    def name(self) -> str:
        return f"{self.module}:{self.lines[0]} {self.operator.removeprefix('core/')} {self.occurrence}"

    def code(self) -> str:
        """The module with the change."""
        changed = mutate_code(source(self.module), plugins.get_operator(self.operator)(), self.occurrence)
        assert isinstance(changed, str)
        return changed

    def change(self) -> str:
        """Lines that differ, before -> after."""
        pairs = zip(source(self.module).splitlines(), self.code().splitlines())
        return "; ".join(f"{before.strip()} -> {after.strip()}" for before, after in pairs if before != after)


@cache
def source(module: str) -> str:
    return (ROOT / module).read_text(encoding="utf-8")


def modules(only: tuple[str, ...] = ()) -> list[str]:
    """Paths of all modules relative to the root, or of those below the paths ``only``."""
    found = (
        path.relative_to(ROOT).as_posix() for package in PACKAGES for path in (ROOT / package).rglob("*.py")
    )
    return sorted(m for m in found if not DRAWING.fullmatch(m) and (not only or m.startswith(only)))


def drawn(count: int, seed: int, only: tuple[str, ...] = ()) -> list[Mutant]:
    """``count`` mutants, the same for the same seed and code; as many of each package as of the others."""
    chance = random.Random(seed)
    shares = [[m for m in modules(only) if m.startswith(f"{package}/")] for package in PACKAGES]
    shares = [share for share in shares if share]
    mutants: dict[str, Mutant] = {}
    while len(mutants) < count:
        share = shares[len(mutants) % len(shares)]
        (module,) = chance.choices(share, [source(m).count("\n") + 1 for m in share])
        places = mutants_of(module)
        if not places:
            continue
        mutant = chance.choice(places[chance.choice(sorted(places))])
        if mutant.name not in mutants and _compiles(mutant):
            mutants[mutant.name] = mutant
    return list(mutants.values())


@cache
def mutants_of(module: str) -> dict[tuple[int, int], list[Mutant]]:
    """Every mutant of a module by its place (line, column)."""
    found: dict[tuple[int, int], list[Mutant]] = defaultdict(list)
    nodes = list(ast_nodes(get_ast(source(module))))
    for name in filter(OPERATORS.fullmatch, plugins.operator_names()):
        operator = plugins.get_operator(name)()
        places = ((node, start) for node in nodes for start, _ in operator.mutation_positions(node))
        for occurrence, (node, start) in enumerate(places):
            binary = "BinaryOperator" in name
            if binary and node.parent.type not in BINARY_PARENTS:
                continue
            if not _is_left_out(node):
                lines = _statement(node)
                mutant = Mutant(module=module, operator=name, occurrence=occurrence, lines=lines)
                found[start].append(mutant)
    return dict(found)


def _above(node: NodeOrLeaf) -> Iterator[tuple[NodeOrLeaf, NodeOrLeaf]]:
    """(node, what holds it) up to the module."""
    while node.parent is not None:
        yield node, node.parent
        node = node.parent


def _is_left_out(node: NodeOrLeaf) -> bool:
    if node.type == "number" and abs(ast.literal_eval(node.value)) > LARGEST:
        return True
    for child, parent in _above(node):
        if parent.type in ("decorator", "fstring_format_spec"):
            return True
        if parent.type == "annassign" and child is parent.children[1]:
            return True
        if parent.type in ("param", "funcdef") and child is parent.annotation:
            return True
    return False


def _statement(node: NodeOrLeaf) -> tuple[int, int]:
    """First and last line of the statement of a node; of a compound one, of its head as far as the node."""
    for child, parent in _above(node):
        if child.type in ("simple_stmt", "expr_stmt", "return_stmt"):
            return child.start_pos[0], child.get_last_leaf().start_pos[0]
        if parent.type in ("suite", "file_input"):
            return child.start_pos[0], node.start_pos[0]
    return node.start_pos[0], node.start_pos[0]


def _compiles(mutant: Mutant) -> bool:
    try:
        compile(mutant.code(), mutant.module, "exec")
    except SyntaxError:
        return False
    return True
