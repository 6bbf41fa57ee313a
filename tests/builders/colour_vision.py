"""What a colour looks like to a red-green blind reader, and how far apart two colours are.

Machado, Oliveira and Fernandes, "A Physiologically-based Model for Simulation of Color Vision Deficiency", IEEE
Transactions on Visualization and Computer Graphics 15 (2009) 6, table of matrices, severity 1.0, in linear RGB.
Distances in CIE 1976 L*a*b* (D65); contrast and relative luminance of WCAG 2.1.
"""

import numpy as np

VISIONS = {
    "normal": np.eye(3),
    "deuteranopia": np.array(
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ]
    ),
    "protanopia": np.array(
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ]
    ),
}
RGB_TO_XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
WHITE = RGB_TO_XYZ.sum(axis=1)


def to_linear(values):
    """sRGB, 0 to 1, to linear RGB (IEC 61966-2-1)."""
    values = np.asarray(values, dtype=float)
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def from_linear(values):
    """Linear RGB to sRGB, 0 to 1."""
    values = np.clip(values, 0.0, 1.0)
    return np.where(values <= 0.0031308, 12.92 * values, 1.055 * values ** (1 / 2.4) - 0.055)


def linear_rgb(colour):
    """``#rrggbb`` as linear RGB."""
    return to_linear([int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)])


def seen_lab(colour, vision):
    """L*a*b* of ``#rrggbb`` as seen with ``vision``."""
    relative = RGB_TO_XYZ @ np.clip(VISIONS[vision] @ linear_rgb(colour), 0.0, 1.0) / WHITE
    f = np.where(relative > 216 / 24389, np.cbrt(relative), (24389 / 27 * relative + 16) / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def distance(first, second, vision):
    """Colour difference ΔE*ab (CIE 1976) of two colours as seen with ``vision``."""
    return float(np.linalg.norm(seen_lab(first, vision) - seen_lab(second, vision)))


def contrast_on_white(colour):
    """Contrast ratio of WCAG 2.1 against white, 1 to 21."""
    return float(1.05 / (0.05 + RGB_TO_XYZ[1] @ linear_rgb(colour)))
