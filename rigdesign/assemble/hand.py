"""Numbers an engineer can redo on paper beside the key results."""

import math
from typing import Any

from rigdesign.checks.subject import Subject


def hand_checks(subject: Subject) -> list[dict[str, Any]]:
    """quantity, computed, by_hand, unit, formula; in the order of the report."""
    return [*_loads(subject), *_losses(subject), *_growth(subject)]


def _row(quantity: str, computed: float, by_hand: float, unit: str, formula: str) -> dict[str, Any]:
    return {"quantity": quantity, "computed": computed, "by_hand": by_hand, "unit": unit, "formula": formula}


def _loads(subject: Subject) -> list[dict[str, Any]]:
    last, rig = subject.test.last, subject.rig
    rows = []
    for model in last.models:
        box, mesh = rig.mesh(model.name)
        shaft = box.gears[box.meshes[mesh].pinion].shaft
        speed = rig.shaft_speed(shaft, subject.test.point.speed)
        torque = abs(last.feedback.mesh_torque[model.name])
        stiffness, pair = model.law.mean_stiffness, model.pair
        deflection = torque / pair.base_radii[0] / stiffness
        rows.append(
            _row(
                f"mesh frequency, {model.name}", speed * pair.teeth[0] / (2.0 * math.pi),
                pair.teeth[0] * speed * 30.0 / math.pi / 60.0, "Hz", "z_1 n_1 / 60",
            )
        )  # fmt: skip
        if last.response is not None:
            index = rig.mesh_names.index(model.name)
            approach = abs(last.response.wave.approach[index].mean())
            if last.response.flank[index] < 0:
                approach -= model.law.backlash
            rows.append(
                _row(
                    f"mean tooth deflection, {model.name}", 1e6 * approach, 1e6 * deflection, "um",
                    "T_1 / (r_b1 c_gamma b); crowning and early contact explain the difference",
                )
            )  # fmt: skip
    return rows


def _losses(subject: Subject) -> list[dict[str, Any]]:
    rows = []
    for placed in subject.test.last.losses:
        details = placed.loss.details
        if placed.loss.kind == "mesh" and not placed.given:
            by_hand = math.prod(
                float(details[key])
                for key in ("transmitted_power", "friction_coefficient", "tooth_loss_factor")
            )
            rows.append(
                _row(
                    f"sliding loss, {placed.name}", placed.loss.power, by_hand, "W",
                    "P mu H_V of rigid teeth; deflected ones share the load beyond the ends of the path. The gear bulk "
                    "temperature hangs on the difference",
                )
            )  # fmt: skip

    for row in subject.cooler:
        given, taken = (
            math.fsum(float(row[key]) for key in keys)
            for keys in (("losses_W", "heater_W"), ("cooler_W", "room_W"))
        )
        rows.append(
            _row(f"heat carried away, stage {row['stage']}", taken, given, "W", "cooler + room = losses + heaters")
        )  # fmt: skip
    return rows


def _growth(subject: Subject) -> list[dict[str, Any]]:
    rows = []
    for result in subject.growth:
        rows += [
            _row(
                f"growth of {shaft['shaft']}", shaft["growth_mm"], shaft["free_expansion_mm"], "mm",
                "alpha L (T_m - T_0)",
            )
            for shaft in result.shafts
        ]  # fmt: skip
        rows += [
            _row(
                f"mean gap of seal {seal['seal']}", seal["hot_mean_mm"], seal["by_hand_mm"], "mm",
                "s + R [alpha_h (T_h - T_0) - alpha_s (T_s - T_0)]",
            )
            for seal in result.seal_gaps
        ]  # fmt: skip
    return rows
