"""Drake: joint coordinates, Runge-Kutta 3 with error control on the continuous plant.

A continuous plant has no constraints that close loops and no contact of a journal in a bearing:
only the chain is run.
"""

import time
from collections.abc import Iterator
from typing import Any

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import BallRpyJoint, FixedOffsetFrame, SpatialInertia, UnitInertia
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator

from benchmarks.peers import Measured, cpu_of
from benchmarks.peers.mechanism import tip_error
from benchmarks.problems import (
    ABOUT,
    ACROSS,
    LENGTH,
    MASS,
    Rod,
    chain,
    straight_rods,
    zigzag_rods,
)
from trsim.scenario.load import loads

WITHOUT = "not run: its continuous plant closes no loops and has no journal in a bearing"
END = [0.5 * LENGTH, 0.0, 0.0]  # m, of a rod
END_TIME = 0.2  # s
LONG = 5.0  # s: a run of more is not repeated
SHORT = 10  # rods


def plant_of(n: int) -> Any:
    """The chain of P5, drawn as one straight line."""
    plant = MultibodyPlant(time_step=0.0)
    inertia = SpatialInertia(
        MASS, np.zeros(3), UnitInertia(ABOUT / MASS, ACROSS / MASS, ACROSS / MASS)
    )
    outer, at = plant.world_body(), np.zeros(3)
    for i in range(n):
        rod = plant.AddRigidBody(f"rod{i}", inertia)
        plant.AddJoint(BallRpyJoint(f"ball{i}", *ends(plant, outer, at, rod)))
        outer, at = rod, np.array(END)
    plant.mutable_gravity_field().set_gravity_vector(loads(chain(1)).gravity)
    plant.Finalize()
    return plant


def ends(plant: Any, outer: Any, at: np.ndarray, rod: Any) -> tuple[Any, Any]:
    """The frames that a ball joint holds together."""
    here = plant.AddFrame(FixedOffsetFrame(f"{rod.name()}_outer", outer, RigidTransform(at)))
    there = RigidTransform(-np.array(END))
    return here, plant.AddFrame(FixedOffsetFrame(f"{rod.name()}_inner", rod, there))


def begin(plant: Any, context: Any, chain: list[Rod]) -> None:
    """Angles and rates of the joints, those of a rod against the one before it."""
    before, R, omega = 0.0, np.eye(3), np.zeros(3)
    for i, rod in enumerate(chain):
        along, across = np.cos(rod.angle), np.sin(rod.angle)
        own = np.array([rod.spin * along, rod.turn + rod.spin * across, 0.0])
        joint = plant.GetJointByName(f"ball{i}")
        joint.set_angles(context, [0.0, 0.0, rod.angle - before])
        joint.set_angular_velocity(context, R.T @ (own - omega))
        R = np.array([[along, -across, 0.0], [across, along, 0.0], [0.0, 0.0, 1.0]])
        before, omega = rod.angle, own


def solved(plant: Any, chain: list[Rod], accuracy: float) -> tuple[float, np.ndarray, int]:
    """CPU time s, tip (3,) m, steps."""
    simulator = Simulator(plant)
    integrator = ResetIntegratorFromFlags(simulator, "runge_kutta3", END_TIME)
    integrator.set_target_accuracy(accuracy)
    context = simulator.get_mutable_context()
    begin(plant, context, chain)
    simulator.Initialize()
    clock = time.process_time()
    simulator.AdvanceTo(END_TIME)
    cpu = time.process_time() - clock
    frame = plant.GetBodyByName(f"rod{len(chain) - 1}").body_frame()
    tip = plant.CalcPointsPositions(context, frame, END, plant.world_frame()).ravel()
    return cpu, tip, simulator.get_integrator().get_num_steps_taken()


def measured(chain: list[Rod], kind: str) -> Iterator[Measured]:
    """The chain at two accuracies, a short one at three; kind: straight or bending."""
    n = len(chain)
    plant = plant_of(n)
    for accuracy in (1e-4, 1e-6, 1e-8) if n <= SHORT else (1e-4, 1e-6):
        cpu, tip, steps = solved(plant, chain, accuracy)
        if cpu < LONG:
            cpu = cpu_of(lambda a=accuracy: solved(plant, chain, a)[0])
        yield Measured(f"RK3, accuracy {accuracy:g}", cpu, tip_error(tip, n, kind), steps)


PROBLEMS = {
    "chain": lambda n: measured(straight_rods(n), "straight"),
    "bending_chain": lambda n: measured(zigzag_rods(n), "bending"),
}
