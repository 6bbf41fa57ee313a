"""Prints the stored contact runs next to the analytic model and ISO 6336-3.

``python -m tests.reference.tooth_contact.tables``; the first number of two is that of CalculiX.
"""

import json
from typing import Any

import numpy as np

from tests.reference.tooth_contact import analytic
from tests.reference.tooth_contact.contact_cases import contact_case
from tests.reference.tooth_contact.run import CASES, STORED

MPA, MICRO = 1e-6, 1e6


def stored() -> dict[str, Any]:
    """Contents of ``measured.json``."""
    return dict(json.loads(STORED.read_text()))


def records(
    case: str, *, mesh: str = "standard", penalty: float = 1.0, sweep: bool = False
) -> list[dict[str, Any]]:
    """Records of a case, the three positions alone unless the whole base pitch is wanted, by rising path position."""
    chosen = [
        record
        for record in stored()["records"]
        if record["case"] == case
        and record["mesh"] == mesh
        and record["penalty"] == penalty
        and (record["position"] == "middle" or sweep == record["position"].startswith("sweep"))
    ]
    return sorted(chosen, key=lambda record: record["path"])


def over_path(case: str) -> tuple[np.ndarray, np.ndarray]:
    """Path position [m] (n,) under load and (n, 3) share and root stress of pinion and wheel [Pa] of one tooth pair,
    put together from the pairs of the sweep."""
    rows = [
        (tooth["path"] + record["approach"], tooth["share"], *tooth["root_stress"])
        for record in records(case, sweep=True)
        for tooth in record["pairs"]
    ]
    table = np.array(sorted(rows))
    return table[:, 0], table[:, 1:]


def contact_ratio(path: np.ndarray, share: np.ndarray, base_pitch: float) -> float:
    """Length of the path that carries, over the base pitch; its ends halfway between the steps about them."""
    carrying = np.flatnonzero(share > 1e-4)
    first, last = int(carrying[0]), int(carrying[-1])
    start = 0.5 * (path[first - 1] + path[first])
    end = 0.5 * (path[last] + path[last + 1])
    return float((end - start) / base_pitch)


def _pairs(values: list[float], form: str = ".3f") -> str:
    return " ".join(format(value, form) for value in values)


def _positions(name: str) -> None:
    case = contact_case(name)
    for mesh in ("coarse", "standard", "fine"):
        for record in records(name, mesh=mesh):
            ours = analytic.loaded(case, record["path"])
            teeth = record["pairs"]
            largest = [MPA * max(tooth["root_stress"][k] for tooth in teeth) for k in (0, 1)]
            print(
                f"{name:13s} {record['position']:7s} {mesh:9s} {record['nodes']:7d} | share "
                f"{_pairs([max(t['share'], 0.0) for t in teeth])} / {_pairs(ours['shares'])} | approach "
                f"{MICRO * record['approach']:.2f} - {MICRO * case.body_twist:.2f} / {MICRO * ours['approach']:.2f} | "
                f"root {_pairs(largest, '.0f')} / {_pairs(list(np.max(ours['root_stress'], axis=0) * MPA), '.0f')} | "
                f"pressure {MPA * max(t['pressure'] for t in teeth):.0f} | balance {record['torque_balance']:+.1e}"
            )


def _sweep(name: str) -> None:
    case = contact_case(name)
    path, values = over_path(name)
    pitch = case.pair.base_pitch
    fine = np.linspace(-0.5, 0.5, 241)[:-1] * pitch + 0.5 * (case.pair.path.start + case.pair.path.end)
    ours = [analytic.loaded(case, place) for place in fine]
    share = np.array([row["shares"] for row in ours])
    roots = np.max([row["root_stress"] for row in ours], axis=(0, 1)) * MPA
    approach = np.array([row["approach"] for row in ours]) * MICRO
    found = np.array([record["approach"] for record in records(name, sweep=True)]) * MICRO
    print(
        f"{name}: largest share {values[:, 0].max():.3f} / {share.max():.3f}; loaded contact ratio "
        f"{contact_ratio(path, values[:, 0], pitch):.2f} / {(share > 1e-4).sum() / len(fine):.2f}; approach "
        f"{found.min():.1f} .. {found.max():.1f} (mean {found.mean():.1f}) less {MICRO * case.body_twist:.1f} / "
        f"{approach.min():.1f} .. {approach.max():.1f} (mean {approach.mean():.1f}) um; root stress "
        f"{_pairs(list(values[:, 1:].max(axis=0) * MPA), '.0f')} / {_pairs(list(roots), '.0f')}, ISO "
        f"{_pairs([analytic.iso_root_stress(case, k) * MPA for k in (0, 1)], '.0f')} MPa"
    )
    limits = case.pair.path
    for place, (part, pinion, wheel) in zip(path, values, strict=True):
        if part > 1e-4 or pinion > 0.2 * values[:, 1].max():
            where = (place - limits.start) / pitch
            print(
                f"   (s - A)/p_b {where:6.3f}  share {part:.3f}  root {pinion * MPA:5.0f} {wheel * MPA:5.0f}"
            )


def main() -> None:
    """Print all tables."""
    for name in CASES:
        _positions(name)
    for name, factor in (("uhcf_crowned", 5.0), ("fzg_c", 5.0)):
        for record in records(name, penalty=factor):
            print(name, record["position"], "penalty", factor, MICRO * record["approach"],
                  [round(tooth["share"], 4) for tooth in record["pairs"]],
                  [round(MPA * max(t["root_stress"][k] for t in record["pairs"]), 1) for k in (0, 1)])  # fmt: skip
    for name in CASES:
        _sweep(name)


if __name__ == "__main__":
    main()
