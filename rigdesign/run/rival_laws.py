"""How far the checks depend on which published law gives a loss.

Churning of small gears lies a factor of five apart between laws, windage more than that. The converged point is solved
again with the losses of the law that differs most from the one taken, its loads and films kept; what that moves in the
value of a check is an error of it (`rigdesign.checks.rules.with_error`), as that of a mesh is.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.placed_loss import PlacedLoss
from rigdesign.records.solved_rig import LawSpread
from rigdesign.rig.model import Rig
from rigdesign.run.mesh_convergence import checked, on_mesh

NOTABLE = 0.3
"""Share of a loss by which another law has to differ to count: below it laws agree as well as measurements do."""
LEAST_SHARE = 0.01
"""Share of all losses of a rig below which nothing is solved again."""
PASSES, SETTLED = 4, 0.05
"""Iterations that the oil is given to follow, and its last change [K]."""


def law_spreads(rig: Rig, points: Sequence[PointResult]) -> Iterator[LawSpread]:
    """For each kind of loss whose laws differ notably, what the other law changes in every check of heat.

    points : held, as they converged on the meshes of ``rig``
    """
    kinds = {placed.loss.kind for point in points for placed in point.last.losses if placed.rival}
    base = None
    for kind in sorted(kinds):
        changed = [_exchanged(point, kind) for point in points]
        if all(point is None for point in changed):
            continue
        base = base or _values(rig, points)
        solved = [
            point if other is None else _settled(rig, other)
            for point, other in zip(points, changed, strict=True)
        ]
        moved = {id_: abs(value - base[id_]) for id_, value in _values(rig, solved).items() if id_ in base}
        yield LawSpread(cause=_words(points, kind), changes=moved)


def _exchanged(point: PointResult, kind: str) -> PointResult | None:
    """A point with the losses of the rival law, not solved again; None where they matter little."""
    losses = point.last.losses
    rivals = {id(p): p.rival[1] for p in losses if p.loss.kind == kind and p.rival}
    own = math.fsum(p.loss.power for p in losses if id(p) in rivals)
    change = abs(math.fsum(rivals.values()) - own)
    if change < max(NOTABLE * own, LEAST_SHARE * math.fsum(p.loss.power for p in losses)):
        return None
    exchanged = tuple(_with_power(p, rivals[id(p)]) if id(p) in rivals else p for p in losses)
    return replace(point, last=replace(point.last, losses=exchanged))


def _with_power(placed: PlacedLoss, power: float) -> PlacedLoss:
    share = placed.into_body / placed.loss.power if placed.loss.power else 0.0
    return replace(placed, loss=replace(placed.loss, power=power), into_body=share * power)


def _settled(rig: Rig, point: PointResult) -> PointResult:
    """The point with its fields and oil at the temperatures that its losses lead to."""
    for _ in range(PASSES):
        before = point.last.coupling_state.oil_outlet
        point = on_mesh(rig, point, rig, oil_follows=True)
        after = point.last.coupling_state.oil_outlet
        if max((abs(after[name] - value) for name, value in before.items()), default=0.0) < SETTLED:
            break
    return point


def _values(rig: Rig, points: Sequence[PointResult]) -> Mapping[str, float]:
    found = checked(rig, points)
    return {id_: check.value for id_, check in found.items() if check.value is not None}


def _words(points: Sequence[PointResult], kind: str) -> str:
    """What both laws give in every gearbox, at the fastest stage."""
    point = max(points, key=lambda point: point.point.speed)
    texts = []
    for box in dict.fromkeys(p.gearbox for p in point.last.losses if p.loss.kind == kind and p.rival):
        placed = [p for p in point.last.losses if p.loss.kind == kind and p.gearbox == box and p.rival]
        own = math.fsum(p.loss.power for p in placed)
        other = math.fsum(p.rival[1] for p in placed if p.rival)
        details, rival = placed[0].loss.details, placed[0].rival
        law = details.get("law", details["source"])
        assert rival is not None
        texts.append(f"{box} {own:.3g} W by {law}, {other:.3g} W by {rival[0]}")
    return f"{kind} at stage {point.point.stage} ({'; '.join(texts)})"
