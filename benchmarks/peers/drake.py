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
from benchmarks.problems import ABOUT, ACROSS, LENGTH, MASS, chain
from trsim.spec.load import loads

WITHOUT = "not run: its continuous plant closes no loops and has no journal in a bearing"
END = [0.5 * LENGTH, 0.0, 0.0]  # m, of a rod
END_TIME = 0.2  # s


def plant_of(n: int) -> Any:
    """The straight chain of P5."""
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


def solved(plant: Any, n: int, accuracy: float) -> tuple[float, np.ndarray, int]:
    """CPU time s, tip (3,) m, steps."""
    simulator = Simulator(plant)
    integrator = ResetIntegratorFromFlags(simulator, "runge_kutta3", END_TIME)
    integrator.set_target_accuracy(accuracy)
    context = simulator.get_mutable_context()
    plant.GetJointByName("ball0").set_angular_velocity(context, [0.0, 1.0, 0.0])
    simulator.Initialize()
    clock = time.process_time()
    simulator.AdvanceTo(END_TIME)
    cpu = time.process_time() - clock
    frame = plant.GetBodyByName(f"rod{n - 1}").body_frame()
    tip = plant.CalcPointsPositions(context, frame, END, plant.world_frame()).ravel()
    return cpu, tip, simulator.get_integrator().get_num_steps_taken()


def rods(n: int) -> Iterator[Measured]:
    plant = plant_of(n)
    for accuracy in (1e-4, 1e-6):
        cpu = cpu_of(lambda a=accuracy: solved(plant, n, a)[0])
        _, tip, steps = solved(plant, n, accuracy)
        yield Measured(f"RK3, accuracy {accuracy:g}", cpu, tip_error(tip, n), steps)


PROBLEMS = {"chain": rods}
