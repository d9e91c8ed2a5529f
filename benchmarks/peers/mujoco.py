"""MuJoCo: joint coordinates, RK4 with a fixed step, loops closed by soft equalities.

Tuned: equality solref = 2 h, solimp 0.9999, contacts disabled.  The contact of P1 is a Python
function called in every stage, its impact speed latched at the end of a step.
"""

import time
from collections.abc import Callable, Iterator
from math import cos, hypot, pi, sin, sqrt
from typing import Any

import mujoco
import numpy as np

from benchmarks.peers import Measured, cpu_of
from benchmarks.peers.mechanism import andrews_error, slider_reference, tip_error, tree
from benchmarks.problems import LENGTH, VALIDATION, chain, windows
from trsim.scenario.load import load, loads

WITHOUT = "not run"
KINDS = {"revolute": 'type="hinge" axis="0 0 1"', "spherical": 'type="ball"'}


def model_of(scenario: Any, step: float, tuned: bool = True) -> Any:
    """The scenario's bodies as a tree of joints, loops closed by connect equalities."""
    links, closing = tree(scenario)
    soft = f'solref="{2 * step!r} 1" solimp="0.9999 0.9999 0.001"' if tuned else ""
    integrator = 'integrator="RK4"' if tuned else ""
    equalities = "".join(
        f'<connect body1="{j.bodies[0]}" body2="{j.bodies[1]}" anchor="{row(local)}" {soft}/>'
        for j in closing
        for local in [np.subtract(j.at, scenario.bodies[j.bodies[0]].at)]
    )
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <option timestep="{step!r}" gravity="{row(scenario.gravity)}" {integrator}>
    <flag contact="disable" energy="enable"/>
  </option>
  <worldbody>{sites(scenario, "ground")}{branch(scenario, links, "ground")}</worldbody>
  <equality>{equalities}</equality>
  <tendon>{springs(scenario)}</tendon>
</mujoco>""")


def branch(scenario: Any, links: list[Any], parent: str) -> str:
    """The bodies that hang on a body, as nested elements."""
    origin = scenario.bodies[parent].at if parent != "ground" else (0.0, 0.0, 0.0)
    text = ""
    for link in links:
        if link.parent != parent:
            continue
        body = scenario.bodies[link.body]
        inertia = body.inertia if isinstance(body.inertia, tuple) else (body.inertia,) * 3
        text += f"""
<body name="{link.body}" pos="{row(np.subtract(body.at, origin))}">
  <inertial pos="0 0 0" mass="{body.mass!r}" diaginertia="{row(inertia)}"/>
  <joint name="{link.body}" {KINDS[link.type]} pos="{row(np.subtract(link.at, body.at))}"/>
  {sites(scenario, link.body)}{branch(scenario, links, link.body)}
</body>"""
    return text


def sites(scenario: Any, body: str) -> str:
    """The ends of springs on a body."""
    origin = scenario.bodies[body].at if body != "ground" else (0.0, 0.0, 0.0)
    return "".join(
        f'<site name="{name}_{end}" pos="{row(np.subtract(at, origin))}"/>'
        for name, force in scenario.forces.items()
        if force.type == "spring_damper"
        for end, at in zip(force.bodies, force.points, strict=True)
        if end == body
    )


def springs(scenario: Any) -> str:
    return "".join(
        f'<spatial stiffness="{force.stiffness!r}" springlength="{force.free_length!r}">'
        + "".join(f'<site site="{name}_{end}"/>' for end in force.bodies)
        + "</spatial>"
        for name, force in scenario.forces.items()
        if force.type == "spring_damper"
    )


def row(numbers: Any) -> str:
    return " ".join(repr(float(x)) for x in numbers)


def started(scenario: Any, model: Any) -> Any:
    """The state at the start; rates are against the parent, and all axes are still the world's."""
    data = mujoco.MjData(model)
    links, _ = tree(scenario)
    for link in links:
        rate = np.array(scenario.bodies[link.body].angular_velocity)
        if link.parent != "ground":
            rate = rate - scenario.bodies[link.parent].angular_velocity
        joint = data.joint(link.body)
        joint.qvel[:] = rate if link.type == "spherical" else rate[2]
    for force in scenario.forces.values():
        if force.type == "applied_load":
            data.joint(force.body).qfrc_applied[:] = 0.033
    mujoco.mj_forward(model, data)
    return data


def turned(scenario: Any, data: Any) -> dict[str, float]:
    """The angle every body has turned by."""
    turn = {"ground": 0.0}
    for link in tree(scenario)[0]:
        turn[link.body] = turn[link.parent] + float(data.joint(link.body).qpos[0])
    return turn


def timed(make: Callable[[], Any], model: Any, steps: int) -> float:
    """CPU time of a run from the start, s."""
    data = make()
    model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    clock = time.process_time()
    mujoco.mj_step(model, data, steps)
    cpu = time.process_time() - clock
    model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    return cpu


def andrews(_: int) -> Iterator[Measured]:
    scenario = load(VALIDATION / "andrews.yaml")
    for step in (1e-5, 1e-6):
        model, steps = model_of(scenario, step), round(0.03 / step)
        cpu = cpu_of(lambda m=model, k=steps: timed(lambda: started(scenario, m), m, k))
        data = started(scenario, model)
        mujoco.mj_step(model, data, steps)
        error = andrews_error(scenario, turned(scenario, data))
        yield Measured(f"RK4, tuned, {step:g} s", cpu, error, steps)


def four_bars(n: int) -> Iterator[Measured]:
    scenario = loads(windows(n))
    for step, tuned in ((1e-3, True), (1e-3, False)):
        model, steps = model_of(scenario, step, tuned), round(10.0 / step)
        cpu = cpu_of(lambda m=model, k=steps: timed(lambda: started(scenario, m), m, k))
        data = started(scenario, model)
        energies = [sum(data.energy)]
        for _ in range(1000):
            mujoco.mj_step(model, data, steps // 1000)
            mujoco.mj_energyPos(model, data)
            mujoco.mj_energyVel(model, data)
            energies.append(sum(data.energy))
        error = float(np.max(np.abs(np.array(energies) - energies[0])))
        label = "RK4, tuned" if tuned else "defaults (semi-implicit Euler)"
        yield Measured(f"{label}, {step:g} s", cpu, error, steps)


def rods(n: int) -> Iterator[Measured]:
    scenario, step = loads(chain(n)), 1e-3
    model, steps = model_of(scenario, step), round(0.2 / step)
    cpu = cpu_of(lambda: timed(lambda: started(scenario, model), model, steps))
    data = started(scenario, model)
    mujoco.mj_step(model, data, steps)
    mujoco.mj_kinematics(model, data)
    last = data.body(f"rod{n - 1}")
    tip = last.xpos + 0.5 * LENGTH * last.xmat[0::3]
    yield Measured(f"RK4 {step:g} s", cpu, tip_error(tip, n), steps)


# --- P1 ----------------------------------------------------------------------------------------

# the crank is too heavy to be slowed down
SLIDER_CRANK = """
<mujoco>
  <option timestep="{step!r}" gravity="0 0 0" integrator="RK4"><flag contact="disable"/></option>
  <worldbody>
    <body pos="0 0 0">
      <joint name="crank" type="hinge" axis="0 0 1" armature="1e9"/>
      <inertial pos="0.025 0 0" mass="0.3" diaginertia="1e-4 1e-4 1e-4"/>
      <body pos="0.05 0 0">
        <joint name="rod" type="hinge" axis="0 0 1"/>
        <inertial pos="0.06 0 0" mass="0.21" diaginertia="2.5e-4 2.5e-4 2.5e-4"/>
      </body>
    </body>
    <body pos="0.17 0 0">
      <joint name="slider" type="slide" axis="1 0 0"/>
      <inertial pos="0 0 0" mass="0.14" diaginertia="1e-4 1e-4 1e-4"/>
    </body>
  </worldbody>
</mujoco>"""
RATE = 5000 * 2 * pi / 60
K = 4 / 3 / (2 * (1 - 0.3**2) / 207e9) * sqrt(0.01 * 0.0095 / 0.0005)


class Clearance:
    """The contact of P1 as generalised forces; remembers the speed of the touch."""

    def __init__(self) -> None:
        self.approach = 0.0

    def gap(self, q: Any, v: Any) -> tuple[float, float, float, float, float, float]:
        """Penetration and rate, normal, and the rod's end from the crank pin, m and m/s."""
        theta, phi = float(q[0]), float(q[0] + q[1])
        u_x, u_y = 0.12 * cos(phi), 0.12 * sin(phi)
        c, s = 0.05 * cos(theta), 0.05 * sin(theta)
        e_x, e_y = 0.17 + float(q[2]) - c - u_x, -s - u_y
        spin = float(v[0] + v[1])
        v_x, v_y = float(v[2] + v[0] * s) + spin * u_y, float(-v[0] * c) - spin * u_x
        size = hypot(e_x, e_y)
        n_x, n_y = (e_x / size, e_y / size) if size else (1.0, 0.0)
        return size - 5e-4, v_x * n_x + v_y * n_y, n_x, n_y, u_x, u_y

    def passive(self, model: Any, data: Any) -> None:
        d, rate, n_x, n_y, u_x, u_y = self.gap(data.qpos, data.qvel)
        if d <= 0.0:
            return
        approach = self.approach or max(rate, 1e-6)
        F = max(K * d**1.5 * (1.0 + 0.75 * (1 - 0.9**2) * rate / approach), 0.0)
        data.qfrc_passive[1] += F * (u_x * n_y - u_y * n_x)
        data.qfrc_passive[2] -= F * n_x

    def latch(self, data: Any) -> None:
        d, rate, *_ = self.gap(data.qpos, data.qvel)
        if d <= 0.0:
            self.approach = 0.0
        elif self.approach == 0.0:
            self.approach = max(rate, 1e-6)


def slider_crank(_: int) -> Iterator[Measured]:
    for step in (1e-6, 1e-7):
        every = round(4e-5 / step)
        model = mujoco.MjModel.from_xml_string(SLIDER_CRANK.format(step=step))
        cpu = cpu_of(lambda m=model, e=every: march(m, e)[0])
        _, v = slider_reference()
        error = float(np.max(np.abs(np.array(march(model, every)[1]) - v))) / 30.0
        yield Measured(f"RK4, Python contact, {step:g} s", cpu, error, round(3e-3 / step))


def march(model: Any, every: int) -> tuple[float, list[float]]:
    """Three milliseconds: CPU time, and the slider's velocity every 40 us."""
    data, contact = mujoco.MjData(model), Clearance()
    data.qvel[:] = RATE, -(0.05 / 0.12 + 1.0) * RATE, 0.0
    velocity = [0.0]
    mujoco.set_mjcb_passive(contact.passive)
    try:
        clock = time.process_time()
        for _ in range(75):
            for _ in range(every):
                mujoco.mj_step(model, data)
                contact.latch(data)
            velocity.append(float(data.qvel[2]))
        return time.process_time() - clock, velocity
    finally:
        mujoco.set_mjcb_passive(None)


PROBLEMS = {"slider_crank": slider_crank, "andrews": andrews, "windows": four_bars, "chain": rods}
