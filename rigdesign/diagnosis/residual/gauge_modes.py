"""Modes of the gauges of a gear over its face: common, tilt, curvature, and what is left at each gauge.

Evidence does not depend on whether numbers stand by gauge or by mode, so that gauges may be missing; modes say where a
residual is, and how large an error of the contact model is in each.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rigdesign.diagnosis.statistics.columns import Array, Column
from rigdesign.prediction.model import Channel, Feature

MODES = ("common", "tilt", "curvature")
"""Polynomials over the face, of rising order, orthonormal over the gauges."""
MODEL_ERROR = {"common": 0.07, "tilt": 0.03, "curvature": 0.02}
"""Error of the contact model in a mode and window, alike at all points, over the strain [-]: P1 finds up to 7 % between
gauges and two tooth contact analyses."""
POINT_ERROR = {"common": 0.01, "tilt": 0.005, "curvature": 0.005}
"""The same point by point."""


@dataclass(frozen=True, kw_only=True)
class GaugeRow:
    """The gauges of a gear in one window at one point.

    rows : of their numbers; shapes : mode -> (m,) over the gauges, orthonormal
    """

    gear: str
    window: str
    point: str
    rows: tuple[int, ...]
    shapes: Mapping[str, Array]


def gauge_rows(features: Sequence[Feature], channels: Mapping[str, Channel]) -> Iterator[GaugeRow]:
    """All gauges by gear, window and point."""
    found: dict[tuple[str, str, str], list[int]] = {}
    for row, feature in enumerate(features):
        channel = channels[feature.channel]
        if channel.quantity == "root_strain" and feature.part != "unloaded":
            gear = channel.place.rpartition(".")[0]
            found.setdefault((gear, feature.part, feature.setting), []).append(row)
    for (gear, window, point), rows in found.items():
        face = np.array([channels[features[row].channel].face for row in rows])
        yield GaugeRow(gear=gear, window=window, point=point, rows=tuple(rows), shapes=shapes_over(face))


def shapes_over(face: Array) -> dict[str, Array]:
    """Mode -> (m,) over gauges at face positions (m,) [m]; as many modes as there are different positions."""
    count = min(len(np.unique(face)), len(MODES))
    scaled = (face - face.mean()) / max(float(np.ptp(face)), 1e-9)
    basis, upper = np.linalg.qr(np.vander(scaled, count, increasing=True))
    signs = np.sign(np.diagonal(upper))
    return {mode: basis[:, k] * signs[k] for k, mode in enumerate(MODES[:count])}


def mode_columns(features: Sequence[Feature], level: Array, channels: Mapping[str, Channel]) -> list[Column]:
    """Errors of the contact model by gear, window and mode: alike at all points, and point by point.

    level : (n,) strain of each number [-]
    """
    alike: dict[tuple[str, str, str], Array] = {}
    columns = []
    for row in gauge_rows(features, channels):
        at = np.array(row.rows, dtype=np.intp)
        for mode, shape in row.shapes.items():
            here = np.zeros(len(features))
            # a shape of unit mean square over the gauges: the share is of the strain of one gauge
            here[at] = shape * np.sqrt(len(at)) * float(level[at].mean())
            key = (row.gear, row.window, mode)
            alike[key] = alike.get(key, np.zeros(len(features))) + here
            name = f"{mode} of the gauges of {row.gear}, {row.window}"
            columns.append(
                Column(name=f"{name}, {row.point}", kind="sensor", values=here, spread=POINT_ERROR[mode])
            )
    columns += [
        Column(name=f"{mode} of the gauges of {gear}, {window}", kind="sensor", values=values, spread=MODEL_ERROR[mode])
        for (gear, window, mode), values in alike.items()
    ]  # fmt: skip
    return columns
