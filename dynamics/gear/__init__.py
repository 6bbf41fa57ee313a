"""Cylindrical gears and gear pairs: geometry, limits, tooth outline, modifications and deviations of the flanks.

>>> from dynamics.gear import GearPair
>>> pair = GearPair.from_centre_distance(  # FZG type C
...     normal_module=4.5e-3,
...     teeth=(16, 24),
...     centre_distance=91.5e-3,
...     face_widths=(14e-3, 14e-3),
...     profile_shift_1=0.182,
...     thickness_allowances=(50e-6, 60e-6),
... )
>>> print(f"{pair.transverse_contact_ratio:.2f}, x2 = {pair.profile_shifts[1]:.3f}")
1.46, x2 = 0.171
>>> print([f"{1e3 * gear.tip_thickness:.1f} mm" for gear in pair.gears])
['2.6 mm', '2.9 mm']
>>> hot = pair.warm(363.15, 358.15, centre_distance=91.55e-3)  # gears at 90 and 85 degC, housing at 70
>>> print(f"backlash {1e6 * pair.transverse_backlash:.0f} um cold, {1e6 * hot.transverse_backlash:.0f} um hot")
backlash 112 um cold, 95 um hot
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
