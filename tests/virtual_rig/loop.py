"""Truth of a back-to-back loop: what torque cells, encoders and the motor of the rig would read, in time.

    truth = LoopTruth(read_case("cases/loop_1to1/case.toml"), constants, effects)
    answer = truth.solve(Point(speed=314.0, torque=300.0), orders=(1.0, 2.0, 28.0))

Twist locked at rest, static state under way, march over the hunting cycle to its periodic state (reduced rank
extrapolation of the samples once a cycle), orders of the mesh forces, and from these every order of the circuit. What
the teeth exchange with the rotation (`loop_rotation`) joins there; it is too small to come back to the teeth.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tests.virtual_rig import loop_march as kernel
from tests.virtual_rig import teeth as tooth
from tests.virtual_rig.loop_changes import LoopConstants, changed
from tests.virtual_rig.loop_model import Circuit, read_circuit, speed_ratio, standing_frequencies
from tests.virtual_rig.loop_rotation import Rotation, rotation_of

TIME_STEP, LONG_STEP = 1.0e-5, 2.0e-5
"""Longest step where one turn is the cycle, and over a hunting cycle [s]; a mesh and its gears swing at 4 to 8 kHz."""
CUT = 1.5e5
"""Modes of the circuit above it [rad/s] stay out of the march."""
MATERIAL_GROWTH = 11.5e-6
COLD = 293.15
"""Temperature at which the case gives sizes and locked torque, where it says nothing else [K]."""
N_PHASES = 24
SETTLED = 1e-5
"""Change of the state over a cycle, share of the tooth deflection, at which the march ends."""


@dataclass(frozen=True, kw_only=True)
class Point:
    """Operating point: speed [rad/s] and bracing torque [N m] of the reference gear, oil [K], friction, drags."""

    speed: float
    torque: float
    oil: float = 333.15
    friction: Mapping[str, float] = field(default_factory=dict)
    """Coefficient by mesh."""
    drags: Mapping[str, float] = field(default_factory=dict)
    """Braking torque on the shaft of each gear [N m]: bearings, windage, seals."""
    tooth_offset: Mapping[str, int] = field(default_factory=dict)
    """By mesh: teeth by which the wheel was put on further; its eccentricity goes with its teeth."""
    growth: Mapping[str, float] = field(default_factory=dict)
    """By mesh: how much thermal expansion closes each flank, along the path [m]; left out: teeth as warm as the oil."""


@dataclass(frozen=True, kw_only=True)
class LoopAnswer:
    """Truth at one point. Orders per turn of the counted gear, zero angle where it stands at zero."""

    torques: Mapping[str, Mapping[float, complex]]
    """Coupling -> order -> what the first shaft gives to the second [N m]; order 0 is the mean."""
    angles: Mapping[str, Mapping[float, complex]]
    """Shaft -> order -> wobble at the end that no coupling takes [rad]."""
    drive_torque: float
    motor_power: float
    mesh_forces: Mapping[str, np.ndarray]
    """Normal force over the cycle [N]."""
    residual: float
    """Change of the state over the last cycle, share of its size."""
    steps: int


class LoopTruth:
    """A loop with constants of its own and hidden effects; nothing is shared with the checker but the case file."""

    def __init__(
        self,
        tree: Mapping[str, Any],
        constants: LoopConstants | None = None,
        effects: Sequence[Mapping[str, Any]] = (),
    ) -> None:
        self.tree = tree
        self.meshes = [
            tooth.read_teeth(tree, box, mesh)
            for box, entry in tree["gearboxes"].items()
            for mesh in entry["meshes"]
        ]
        self.constants = changed(constants or LoopConstants(), effects, self.meshes)
        self._at_rest: Circuit | None = None
        self.cycle_turns = math.lcm(*(m.z[1] // math.gcd(*m.z) for m in self.meshes))

    def natural_frequencies(self, count: int) -> np.ndarray:
        """At rest, braced with the torque of the first load stage [Hz]."""
        torque = _standing_torque(self.tree)
        circuit = read_circuit(self.tree, self.meshes, 0.0, torque, self.constants.scale, at_rest=True)
        tables = self._tables(circuit, 1.0, 1e-5, Point(speed=0.0, torque=torque), (0.0,) * len(self.meshes))
        forces = self._forces(circuit, torque)
        slopes = [kernel.mean_approach(f, N_PHASES, m, *tables)[1] for m, f in enumerate(forces)]
        return standing_frequencies(circuit, slopes)[:count]

    def backlash(self, mesh: str) -> float:
        """Cold play along the path of contact [m]."""
        found = next(m for m in self.meshes if m.name == mesh)
        return found.backlash * self.constants.scale.get(f"backlash:{mesh}", 1.0)

    def circumferential_play(self, mesh: str) -> float:
        """Cold play on the working pitch circle [m]."""
        found = next(m for m in self.meshes if m.name == mesh)
        return self.backlash(mesh) / math.cos(found.working_angle)

    def sliding_power(self, speed: float, torque: float) -> dict[str, float]:
        """Power [W] each mesh would lose with a coefficient of friction of one."""
        point = Point(speed=speed, torque=torque, friction={m.name: 1.0 for m in self.meshes})
        if self._at_rest is None:
            self._at_rest = read_circuit(self.tree, self.meshes, 100.0, torque, self.constants.scale)
        tables = self._tables(self._at_rest, speed, 1e-5, point, (0.0,) * len(self.meshes))
        found = {}
        for m, (mesh, force) in enumerate(zip(self.meshes, self._forces(self._at_rest, torque))):
            _, _, on_1, on_2 = kernel.mean_approach(force, N_PHASES, m, *tables)
            found[mesh.name] = speed * (on_1 - on_2 * mesh.z[0] / mesh.z[1])
        return found

    def solve(self, point: Point, orders: Sequence[float]) -> LoopAnswer:
        """Periodic state at a point. RuntimeError when the march leaves the tables."""
        circuit = read_circuit(self.tree, self.meshes, point.speed, point.torque, self.constants.scale)
        at_rest = self._state(circuit, point, None)
        warmer = point.oil - self.tree["ambient"].get("reference_temperature", COLD)
        lock = self.constants.lock * (1.0 + self.constants.drift * warmer)
        state = self._state(circuit, point, at_rest["twist"] * lock)
        turn = 2.0 * math.pi / point.speed
        teeth = self.meshes[0].z[0]
        longest = TIME_STEP if self.cycle_turns == 1 else LONG_STEP
        per_turn = teeth * 2 * math.ceil(turn / longest / teeth / 2)
        n_cycle = per_turn * self.cycle_turns
        dt = turn / per_turn
        tables = self._tables(circuit, point.speed, dt, point, state["angles"], state["growth"])
        outer, outer_rate, loads, levers = self._outer(circuit, point, state, n_cycle, dt)
        record, residual, steps = self._march(circuit, tables, state, outer, outer_rate, n_cycle, dt)
        stiff = [kernel.mean_approach(f, N_PHASES, m, *tables)[1] for m, f in enumerate(state["forces"])]
        rotation = rotation_of(circuit, self.meshes, tables, stiff, levers, record, point.speed * dt)
        return self._read(circuit, point, state, record, loads, rotation, orders, residual, steps)

    # ------------------------------------------------------------------ statics

    def _forces(self, circuit: Circuit, torque: float) -> list[float]:
        """Normal forces of both meshes without losses [N]: torque over base radius, equal on one line."""
        at = self.meshes[0]
        counted = self.tree["drivetrain"]["torque_at"]
        radius = at.base_radii[at.gears.index(counted)]
        return [torque / radius * at.base_radii[0] / m.base_radii[0] for m in self.meshes]

    def _state(self, circuit: Circuit, point: Point, twist: float | None) -> dict[str, Any]:
        """Static state: for the twist that makes the torque at rest (None), or under way with the twist locked."""
        running = twist is not None
        cold = self._tables(circuit, point.speed, 1e-5, point, (0.0,) * len(self.meshes))
        growth = [0.0] * len(self.meshes)
        if running:
            growth = [
                point.growth.get(m.name, MATERIAL_GROWTH * (point.oil - COLD) * 0.5 * m.module)
                for m in self.meshes
            ]
        port = _ports(circuit, self.meshes)
        n_meshes = len(self.meshes)
        coupling = circuit.couplings[self.tree["drivetrain"]["bracing"]["coupling"]]
        wind = np.zeros(circuit.size)
        wind[coupling.a], wind[coupling.b] = coupling.stiffness, -coupling.stiffness
        lines = [circuit.lines == line for line in np.unique(circuit.lines[circuit.lines >= 0])]
        drag = np.zeros(circuit.size)
        for gear, value in point.drags.items():
            drag[circuit.seats[gear]] -= value
        inverse = np.linalg.pinv(circuit.stiffness)
        drive = np.zeros(circuit.size)
        drive[circuit.motor] = 1.0
        counted = circuit.gears[self.tree["drivetrain"]["torque_at"]]

        def settle(force: float) -> dict[str, Any]:
            forces = [force] + [0.0] * (n_meshes - 1)
            guess = self._forces(circuit, force * self.meshes[0].base_radii[0])
            rubbing = np.zeros((n_meshes, 2))
            if running:
                rubbing = np.array(
                    [kernel.mean_approach(f, N_PHASES, m, *cold)[2:] for m, f in enumerate(guess)]
                )
            fixed = force * port[0] + (drag if running else 0.0)
            for m in range(n_meshes):
                fixed = fixed + rubbing[m, 0] * port[3 * m + 1] + rubbing[m, 1] * port[3 * m + 2]
            system = np.array([[port[3][line].sum(), drive[line].sum()] for line in lines])
            if running:
                second, torque = np.linalg.solve(system, [-fixed[line].sum() for line in lines])
            else:
                second, torque = guess[1], 0.0
            forces[1] = second
            load = fixed + second * port[3] + torque * drive
            approaches = [kernel.mean_approach(f, N_PHASES, m, *cold)[0] for m, f in enumerate(forces)]
            basis = np.column_stack([inverse @ wind, *(line.astype(float) for line in lines)])
            own = inverse @ load
            wanted = [
                d + _play(m, sign) - g
                for d, m, sign, g in zip(approaches, self.meshes, circuit.directions, growth)
            ]
            rows = np.vstack((circuit.approach @ basis, basis[counted]))
            right = np.append(np.array(wanted) - circuit.approach @ own, -own[counted])
            found = np.linalg.solve(rows, right)
            place = own + basis @ found
            return {
                "twist": found[0], "forces": forces, "rubbing": rubbing, "drive": torque, "approaches": approaches,
                "place": place, "angles": [place[circuit.gears[m.gears[0]]] for m in self.meshes], "growth": growth,
                "wind": wind, "port": port, "drag": drag,
                "wheel_angles": [place[circuit.gears[m.gears[1]]] for m in self.meshes],
            }  # fmt: skip

        force = self._forces(circuit, point.torque)[0]
        state = settle(force)
        if not running:
            return state
        assert twist is not None
        other = 1.02 * force
        far = settle(other)
        for _ in range(6):
            slope = (far["twist"] - state["twist"]) / (other - force)
            force, other, far = force + (twist - state["twist"]) / slope, force, state
            state = settle(force)
            if abs(force - other) < 1e-6 * abs(force):
                break
        return state

    # ------------------------------------------------------------------ tables of the march

    def _tables(
        self,
        circuit: Circuit,
        speed: float,
        dt: float,
        point: Point,
        angles: Sequence[float],
        growth: Sequence[float] | None = None,
    ) -> tuple[np.ndarray, ...]:
        """Numbers, stiffness courses, gaps, tooth gaps, scales, slopes, counts and shifts for the kernel."""
        own = self.constants
        n = len(self.meshes)
        most = max(max(m.z) for m in self.meshes)
        numbers = np.zeros((n, kernel.N_NUMBERS))
        courses = np.zeros((n, tooth.N_PATH))
        gaps = np.zeros((n, tooth.SLICES, tooth.N_PATH))
        tooth_gap, tooth_slope = np.zeros((2, n, 2, most))
        tooth_scale = np.ones((n, 2, most))
        for i, (mesh, sign) in enumerate(zip(self.meshes, circuit.directions)):
            grid = mesh.grid()
            peak = mesh.peak_stiffness * own.scale.get(f"mesh_stiffness:{mesh.name}", 1.0)
            peak *= 1.0 + own.stiffening * point.torque / 400.0
            errors = [own.errors.get(gear, tooth.ToothErrors()) for gear in mesh.gears]
            courses[i] = peak * tooth.stiffness_course(mesh, own.curvature)
            gaps[i] = tooth.path_gaps(mesh, own.relief, [e.tip_relief for e in errors])
            for side, error in enumerate(errors):
                z = mesh.z[side]
                tooth_gap[i, side, :z] = -sign * error.places(z)
                tooth_scale[i, side, :z] = error.stiffness or 1.0
                over_tables = (grid[-1] - grid[0]) / (mesh.end - mesh.start)
                tooth_slope[i, side, :z] = over_tables * np.array(error.slope or 0.0)
            numbers[i, kernel.RATE] = sign * mesh.base_radii[0] * speed * dt
            numbers[i, kernel.PITCH] = mesh.base_pitch
            numbers[i, kernel.START], numbers[i, kernel.STEP] = grid[0], grid[1] - grid[0]
            here = mesh.base_radii[0] * angles[i]
            numbers[i, kernel.OFFSET] = mesh.phase + here if sign > 0 else mesh.back_phase - mesh.phase - here
            mean = peak * mesh.contact_ratio * (1.0 - own.curvature / 3.0)
            damping = mesh.damping * own.scale.get(f"mesh_damping:{mesh.name}", 1.0)
            numbers[i, kernel.DAMP] = damping / mean
            numbers[i, kernel.MU] = point.friction.get(mesh.name, 0.0)
            numbers[i, kernel.ARM_1], numbers[i, kernel.ARM_2] = mesh.rolling_radii
            numbers[i, kernel.HERTZ] = own.hertz
            numbers[i, kernel.DEEP] = tooth.REFERENCE_LINE_LOAD * mesh.face_width / peak
            numbers[i, kernel.BACK_GAP] = mesh.backlash - (2.0 * growth[i] if growth else 0.0)
            numbers[i, kernel.BACK_STIFF] = mean
        counts = np.array([m.z for m in self.meshes])
        shift = np.array([point.tooth_offset.get(m.name, 0) for m in self.meshes])
        return numbers, courses, gaps, tooth_gap, tooth_scale, tooth_slope, counts, shift

    def _outer(
        self, circuit: Circuit, point: Point, state: Mapping[str, Any], n_cycle: int, dt: float
    ) -> tuple[np.ndarray, np.ndarray, list[tuple[float, np.ndarray]], np.ndarray]:
        """Approach that run-out and harmonic torques impose, its rate, the torques as (order, load) [N m], and the

        change of the approach by the run-out of each gear per its own angle (n_meshes, 2, n_cycle) [m].
        """
        time = dt * np.arange(n_cycle)
        outer = np.zeros((len(self.meshes), n_cycle))
        rate = np.zeros_like(outer)
        levers = np.zeros((len(self.meshes), 2, n_cycle))
        for i, (mesh, sign) in enumerate(zip(self.meshes, circuit.directions)):
            for side, gear in enumerate(mesh.gears):
                error = self.constants.errors.get(gear)
                if error is None or not error.run_out:
                    continue
                speed = point.speed * (1.0 if side == 0 else mesh.z[0] / mesh.z[1])
                angle = speed * time + (state["angles"] if side == 0 else state["wheel_angles"])[i]
                further = point.tooth_offset.get(mesh.name, 0) if side == 1 else 0
                wave = error.run_out * np.exp(-1j * (angle + 2.0 * math.pi * further / mesh.z[1]))
                wave *= 1.0 if sign > 0 else _behind(mesh, side)
                outer[i] += wave.real
                rate[i] += speed * wave.imag
                levers[i, side] = wave.imag
        loads = self._harmonic_loads(circuit, point, state)
        for order, load in loads:
            answer = circuit.approach @ circuit.receptance(order * point.speed, load)
            turning = np.exp(1j * order * point.speed * time)
            outer += (answer[:, None] * turning).real
            rate += (1j * order * point.speed * answer[:, None] * turning).real
        return outer, rate, loads, levers

    def _harmonic_loads(
        self, circuit: Circuit, point: Point, state: Mapping[str, Any]
    ) -> list[tuple[float, np.ndarray]]:
        """Torques of motor and couplings by order of the counted gear."""
        loads = []
        for torque in self.constants.torques:
            load = np.zeros(circuit.size, dtype=complex)
            amplitude = torque.at(point.speed, point.torque)
            if torque.place == "motor":
                at = circuit.motor
                load[at] = amplitude
            elif torque.place in circuit.gears:
                at = circuit.seats[torque.place]
                load[at] = amplitude
            else:
                joint = circuit.couplings[torque.place]
                at = joint.a
                load[joint.a], load[joint.b] = -amplitude, amplitude
            ratio = speed_ratio(self.tree, self.meshes, circuit, circuit.lines[at])
            order = torque.order * ratio if torque.frequency is None else torque.locked_order(point.speed)
            if order * self.cycle_turns % 1.0 > 1e-9:
                order = max(round(order * self.cycle_turns), 1) / self.cycle_turns
            loads.append((order, load))
        return loads

    # ------------------------------------------------------------------ march

    def _march(
        self,
        circuit: Circuit,
        tables: tuple[np.ndarray, ...],
        state: Mapping[str, Any],
        outer: np.ndarray,
        outer_rate: np.ndarray,
        n_cycle: int,
        dt: float,
    ) -> tuple[np.ndarray, float, int]:
        port = state["port"]
        n = len(self.meshes)
        keep = (circuit.frequencies > 1.0) & (circuit.frequencies < CUT)
        modes = circuit.modes[:, keep]
        m = modes.shape[1]
        damping = modes.T @ circuit.damping @ modes
        matrix = np.block(
            [[np.zeros((m, m)), np.eye(m)], [-np.diag(circuit.frequencies[keep] ** 2), -damping]]
        )
        roots, shapes = np.linalg.eig(matrix)
        left = np.linalg.inv(shapes)
        upper = roots.imag >= 0.0
        twice = np.where(roots[upper].imag > 0.0, 2.0, 1.0)
        motion = twice * (circuit.approach @ modes @ shapes[:m, upper])
        speed = twice * (circuit.approach @ modes @ shapes[m:, upper])
        kick = (left[upper][:, m:] @ modes.T @ port.T).T
        relative = _relative(circuit)
        inertia = relative @ circuit.mass @ relative
        preload = np.array([
            value for i in range(n) for value in (state["forces"][i], state["rubbing"][i, 0], state["rubbing"][i, 1])
        ])  # fmt: skip
        still = np.array(state["approaches"])
        fixed = (
            np.exp(roots[upper] * dt), np.ascontiguousarray(motion), np.ascontiguousarray(speed),
            np.ascontiguousarray(kick), circuit.approach @ relative, port @ relative / inertia, still, outer,
            outer_rate, preload, *tables,
        )  # fmt: skip
        vector = np.zeros(upper.sum(), dtype=complex)
        rho = np.zeros(2)
        record = np.zeros((4 * n, n_cycle))
        size = np.concatenate(
            (np.abs(motion).max(0), [np.abs(fixed[4]).max(), np.abs(fixed[4]).max() / 400.0])
        )
        span = n_cycle * dt
        steps, residual = 0, 1.0

        def run(times: int) -> None:
            nonlocal steps
            worst = kernel.march(times * n_cycle, 0, dt, vector, rho, *fixed, record)
            steps += times * n_cycle
            if not worst < 1e-2:
                raise RuntimeError(f"loop truth: approach {worst:.3g} m leaves the tables")

        def pack() -> np.ndarray:
            return np.concatenate((vector, rho)) * size

        def unpack(packed: np.ndarray) -> None:
            plain = packed / size
            vector[:] = plain[:-2]
            rho[:] = plain[-2:].real

        scale = max(float(np.abs(outer).max()), float(np.mean(still)))
        run(max(1, round(0.06 / span)))
        for _ in range(6):
            samples = [pack()]
            for _ in range(int(np.clip(1.2 / span, 3, 14))):
                run(1)
                samples.append(pack())
                residual = float(np.linalg.norm(samples[-1] - samples[-2])) / scale
                if residual < SETTLED:
                    break
            if residual < SETTLED:
                break
            unpack(_extrapolated(np.array(samples)))
        return record, residual, steps

    # ------------------------------------------------------------------ reading

    def _read(
        self,
        circuit: Circuit,
        point: Point,
        state: Mapping[str, Any],
        record: np.ndarray,
        loads: Sequence[tuple[float, np.ndarray]],
        rotation: Rotation,
        orders: Sequence[float],
        residual: float,
        steps: int,
    ) -> LoopAnswer:
        forces = record[: 3 * len(self.meshes)]
        spectrum = np.fft.rfft(forces, axis=1) / forces.shape[1]
        port = state["port"]
        bracing = self.tree["drivetrain"]["bracing"]["coupling"]
        motor_ratio = speed_ratio(self.tree, self.meshes, circuit, circuit.lines[circuit.motor])
        uniform = np.zeros(circuit.size)
        for line in np.unique(circuit.lines[circuit.lines >= 0]):
            uniform[circuit.lines == line] = speed_ratio(self.tree, self.meshes, circuit, line)
        mean = port.T @ spectrum[:, 0].real + state["drag"]
        drive = -float(uniform @ mean) / motor_ratio
        mean[circuit.motor] += drive
        twist = state["twist"]
        still = np.linalg.lstsq(circuit.stiffness, mean + twist * state["wind"], rcond=1e-13)[0]
        free = {shaft: self._free_end(circuit, shaft) for shaft in self.tree["drivetrain"]["shafts"]}
        torques: dict[str, dict[float, complex]] = {}
        for name, joint in circuit.couplings.items():
            value = joint.stiffness * (still[joint.a] - still[joint.b] - (twist if name == bracing else 0.0))
            torques[name] = {0.0: complex(value)}
        angles: dict[str, dict[float, complex]] = {shaft: {} for shaft in free}
        for order in orders:
            at = order * self.cycle_turns
            if not order or abs(at - round(at)) > 1e-6:
                continue
            frequency = order * point.speed
            load = 2.0 * port.T @ spectrum[:, round(at)]
            own = [(o, one) for o, one in loads if abs(o - order) < 1e-9]
            for _, one in own:
                load = load + one
            motion = circuit.receptance(frequency, load) + rotation.answer(round(at), frequency)
            for name, joint in circuit.couplings.items():
                stretch = motion[joint.a] - motion[joint.b]
                torques[name][order] = complex((joint.stiffness + 1j * frequency * joint.damping) * stretch)
            for shaft, end in free.items():
                angles[shaft][order] = complex(motion[end])
        for torque, (order, load) in zip(self.constants.torques, loads):
            if torque.place in circuit.couplings and order in torques[torque.place]:
                torques[torque.place][order] += complex(load[circuit.couplings[torque.place].b])
        return LoopAnswer(
            torques=torques,
            angles=angles,
            drive_torque=drive,
            motor_power=drive * point.speed * motor_ratio,
            mesh_forces={mesh.name: forces[3 * i] for i, mesh in enumerate(self.meshes)},
            residual=residual,
            steps=steps,
        )

    def _free_end(self, circuit: Circuit, shaft: str) -> int:
        """Where the encoder sits: the end that no coupling takes, the start where both are free or taken."""
        couplings = self.tree["drivetrain"]["couplings"].values()
        taken = {
            end for entry in couplings for name, end in zip(entry["shafts"], entry["ends"]) if name == shaft
        }
        return circuit.ends[shaft, "end" if taken == {"start"} else "start"]


def _play(mesh: tooth.Teeth, sign: int) -> float:
    """Approach of the working flank stands at -x - backlash on the back: the rest of the way to go [m]."""
    return 0.0 if sign > 0 else mesh.backlash


def _behind(mesh: tooth.Teeth, side: int) -> complex:
    """What stands out on the line of action of the back flanks for one that stands out on that of the front flanks.

    An eccentricity u of the teeth stands out by u . n, n = (sin alpha, +-cos alpha) from the centre towards the other
    gear; the wheel turns the other way, and so does its part.
    """
    return -np.exp((2j, -2j)[side] * mesh.working_angle)


def _ports(circuit: Circuit, meshes: Sequence[tooth.Teeth]) -> np.ndarray:
    """Loads (3 n_meshes, n) of a unit normal force, and of unit friction torques on pinion and wheel."""
    port = np.zeros((3 * len(meshes), circuit.size))
    for i, mesh in enumerate(meshes):
        port[3 * i] = -circuit.approach[i]
        port[3 * i + 1, circuit.gears[mesh.gears[0]]] = -1.0
        port[3 * i + 2, circuit.gears[mesh.gears[1]]] = 1.0
    return port


def _relative(circuit: Circuit) -> np.ndarray:
    """Turning of the two lines against each other, free of the common running (n,)."""
    lines = np.unique(circuit.lines[circuit.lines >= 0])
    first, second = (np.where(circuit.lines == line, 1.0, 0.0) for line in lines)
    ratio = -float(circuit.approach[0] @ first) / float(circuit.approach[0] @ second)
    running = first + ratio * second
    a, b = float(running @ circuit.mass @ first), float(running @ circuit.mass @ second)
    return first - a / b * second


def _extrapolated(samples: np.ndarray) -> np.ndarray:
    """Fixed point of a nearly linear map from its iterates (k + 1, n), by reduced rank extrapolation."""
    steps = np.diff(samples, axis=0)
    real = np.concatenate((steps.real, steps.imag), axis=1)
    second = np.diff(real, axis=0)
    scale = np.linalg.norm(real[0]) or 1.0
    weights = np.linalg.lstsq(second.T / scale, -real[0] / scale, rcond=1e-9)[0]
    return samples[0] + weights @ steps[: len(weights)]


def _standing_torque(tree: Mapping[str, Any]) -> float:
    stage = next(s for s in tree["schedule"]["stages"] if s["kind"] == "load")
    return float(stage.get("torque", stage.get("torque_share", 1.0) * tree["schedule"]["test_torque"]))
