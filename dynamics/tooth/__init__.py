"""Teeth in mesh: influence numbers, loaded contact, mesh law with forces, friction and sliding, root stress.

With the pair of `dynamics.gear`, under load stage 10 of the FZG test:

>>> from dynamics.gear import Microgeometry
>>> from dynamics.tooth import MeshDissipation, mesh_law, pair_stiffness, static_cycle
>>> force = 302.0 / pair.base_radii[0]
>>> relieved = Microgeometry(tip_relief=35e-6, tip_relief_length=2.5e-3)
>>> law = mesh_law(
...     pair,
...     pair_stiffness(pair, force / pair.face_width),
...     (relieved, relieved),
...     dissipation=MeshDissipation(damping=1.5e3, friction=0.05),
... )
>>> cycle = static_cycle(law, force)
>>> print(f"transmission error {1e6 * (cycle.approach.max() - cycle.approach.min()):.0f} um")
transmission error 18 um
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
