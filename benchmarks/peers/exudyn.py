"""Exudyn: redundant coordinates, implicit integration with a fixed step.

Modified Newton and default tolerances; generalised-alpha with spectral radius 0.9 (windows 0.95),
for the contact the index-2 trapezoidal rule without the recommended step size; sparse linear solver
from ten bodies on.
"""

import itertools
import time
from collections.abc import Iterator
from math import pi
from typing import Any

import exudyn as exu
import exudyn.itemInterface as items
import numpy as np
from exudyn.rigidBodyUtilities import RigidBodyInertia

from benchmarks.peers import Measured, cpu_of
from benchmarks.peers.mechanism import (
    andrews_error,
    planar_bodies,
    slider_reference,
    tip_error,
)
from benchmarks.problems import ABOUT, ACROSS, LENGTH, MASS, VALIDATION, chain, windows
from trsim.scenario.load import load, loads

COORDINATES, RATES = exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t
WITHOUT = "not run"


class Planar:
    """A planar mechanism of a scenario: bodies, pins, springs and torques."""

    def __init__(self, scenario: Any) -> None:
        self.scenario = scenario
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        self.ground = self.mbs.AddObject(items.ObjectGround())
        self.node, self.body, self.at = {}, {"ground": self.ground}, {"ground": np.zeros(3)}
        for name, body, inertia in planar_bodies(scenario):
            rates = [*body.velocity[:2], body.angular_velocity[2]]
            node = self.mbs.AddNode(items.NodeRigidBody2D(
                referenceCoordinates=[*body.at[:2], 0.0], initialVelocities=rates))  # fmt: skip
            self.node[name], self.at[name] = node, np.array(body.at)
            self.body[name] = self.mbs.AddObject(items.ObjectRigidBody2D(
                mass=body.mass, inertia=inertia, nodeNumber=node))  # fmt: skip
            if any(scenario.gravity):
                centre = self.mbs.AddMarker(items.MarkerBodyMass(bodyNumber=self.body[name]))
                self.mbs.AddLoad(items.LoadMassProportional(
                    markerNumber=centre, loadVector=list(scenario.gravity)))  # fmt: skip
        for joint in scenario.joints.values():
            if joint.type == "revolute":
                pins = [self.point(name, joint.at) for name in joint.bodies]
                self.mbs.AddObject(items.ObjectJointRevolute2D(markerNumbers=pins))
        for force in scenario.forces.values():
            self.add(force)

    def point(self, name: str, at: Any, rigid: bool = False) -> Any:
        """A marker on a body at a place as drawn."""
        kind = items.MarkerBodyRigid if rigid else items.MarkerBodyPosition
        local = list(np.array(at) - self.at[name])
        return self.mbs.AddMarker(kind(bodyNumber=self.body[name], localPosition=local))

    def coordinate(self, name: str, k: int) -> Any:
        return self.mbs.AddMarker(
            items.MarkerNodeCoordinate(nodeNumber=self.node[name], coordinate=k)
        )

    def add(self, force: Any) -> None:
        if force.type == "spring_damper":
            ends = [self.point(*p) for p in zip(force.bodies, force.points, strict=True)]
            self.mbs.AddObject(items.ObjectConnectorSpringDamper(
                markerNumbers=ends, referenceLength=force.free_length,
                stiffness=force.stiffness))  # fmt: skip
        else:
            self.mbs.AddLoad(items.LoadCoordinate(
                markerNumber=self.coordinate(force.body, 2), load=0.033))  # fmt: skip

    def turn(self) -> dict[str, float]:
        return {k: self.mbs.GetNodeOutput(n, COORDINATES)[2] for k, n in self.node.items()}


def settings(end: float, step: float, bodies: int, radius: float = 0.9) -> Any:
    """The settings of the file's head."""
    s = exu.SimulationSettings()
    s.timeIntegration.endTime = end
    s.timeIntegration.numberOfSteps = round(end / step)
    s.timeIntegration.generalizedAlpha.spectralRadius = radius
    s.timeIntegration.newton.useModifiedNewton = True
    s.timeIntegration.discontinuous.useRecommendedStepSize = False
    s.solutionSettings.writeSolutionToFile = False
    s.solutionSettings.sensorsWritePeriod = end
    if bodies >= 10:
        s.linearSolverType = exu.LinearSolverType.EigenSparse
    return s


def solved(mbs: Any, s: Any, method: Any = exu.DynamicSolverType.GeneralizedAlpha) -> float:
    """CPU time of a run from the start, s."""
    clock = time.process_time()
    mbs.SolveDynamic(s, solverType=method)
    return time.process_time() - clock


def andrews(_: int) -> Iterator[Measured]:
    model = Planar(load(VALIDATION / "andrews.yaml"))
    model.mbs.Assemble()
    for step in (1e-5, 1e-6):
        s = settings(0.03, step, 7)
        cpu = cpu_of(lambda s=s: solved(model.mbs, s))
        error = andrews_error(model.scenario, model.turn())
        yield Measured(f"generalised-alpha {step:g} s", cpu, error, round(0.03 / step))


def four_bars(n: int) -> Iterator[Measured]:
    scenario, step = loads(windows(n)), 1e-3
    s, model = settings(10.0, step, 2 * n + 1, 0.95), Planar(scenario)
    model.mbs.Assemble()
    cpu = cpu_of(lambda: solved(model.mbs, s))
    watched = Planar(scenario)
    sensors = {
        (name, output): watched.mbs.AddSensor(
            items.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=output)
        )
        for name, node in watched.node.items()
        for output in (COORDINATES, RATES)
    }
    watched.mbs.Assemble()
    s.solutionSettings.sensorsWritePeriod = 0.01
    solved(watched.mbs, s)
    stored = {k: watched.mbs.GetSensorStoredData(v)[:, 1:] for k, v in sensors.items()}
    error = energy_error(scenario, stored)
    yield Measured(f"generalised-alpha {step:g} s", cpu, error, round(10.0 / step))


def energy_error(scenario: Any, stored: Any) -> float:
    """Largest change of kinetic and potential energy, J."""
    total = 0.0
    for name, body, inertia in planar_bodies(scenario):
        q, v = stored[name, COORDINATES], stored[name, RATES]
        total = (
            total + 0.5 * body.mass * (v[:, 0] ** 2 + v[:, 1] ** 2) + 0.5 * inertia * v[:, 2] ** 2
        )
        total = total - body.mass * scenario.gravity[1] * q[:, 1]
    return float(np.max(np.abs(total - total[0])))


def rods(n: int) -> Iterator[Measured]:
    scenario = loads(chain(n))
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    outer = mbs.AddObject(items.ObjectGround())
    end = [0.0, 0.0, 0.0]
    inertia = RigidBodyInertia(MASS, np.diag([ABOUT, ACROSS, ACROSS]))
    for body in scenario.bodies.values():
        rod = mbs.CreateRigidBody(
            inertia=inertia, referencePosition=list(body.at), initialVelocity=list(body.velocity),
            initialAngularVelocity=list(body.angular_velocity), gravity=list(scenario.gravity),
            nodeType=exu.NodeType.RotationEulerParameters)  # fmt: skip
        pins = [mbs.AddMarker(items.MarkerBodyPosition(bodyNumber=b, localPosition=p))
                for b, p in ((outer, end), (rod, [-0.5 * LENGTH, 0.0, 0.0]))]  # fmt: skip
        mbs.AddObject(items.ObjectJointSpherical(markerNumbers=pins))
        outer, end = rod, [0.5 * LENGTH, 0.0, 0.0]
    mbs.Assemble()
    s, step = settings(0.2, 1e-3, n), 1e-3
    cpu = cpu_of(lambda: solved(mbs, s))
    tip = mbs.GetObjectOutputBody(outer, exu.OutputVariableType.Position, end)
    yield Measured(f"generalised-alpha {step:g} s", cpu, tip_error(tip, n), round(0.2 / step))


def slider_crank(_: int) -> Iterator[Measured]:
    for step in (1e-6, 1e-7, 2e-8):
        mbs = crank_model(False).mbs
        s = settings(3e-3, step, 3)
        method = exu.DynamicSolverType.TrapezoidalIndex2
        cpu = cpu_of(lambda mbs=mbs, s=s, method=method: solved(mbs, s, method))
        model = crank_model(True)
        s.solutionSettings.sensorsWritePeriod = 4e-5
        solved(model.mbs, s, method)
        stored = model.mbs.GetSensorStoredData(0)
        t, v = slider_reference()
        error = np.max(np.abs(np.interp(t, stored[:, 0], stored[:, 1]) - v)) / 30.0
        yield Measured(f"index-2 trapezoidal {step:g} s", cpu, error, round(3e-3 / step))


def crank_model(sensor: bool) -> Planar:
    """P1: a sphere in a hollow sphere; 0.905 gives its law the damping of L-N at 0.9."""
    scenario = load(VALIDATION / "slider_crank_frictionless.yaml")
    rate = 5000 * 2 * pi / 60
    sets = {"crank": (0.025 * rate, rate), "rod": (0.025 * rate, -0.05 / 0.12 * rate)}
    for name, (v_y, omega) in sets.items():
        scenario.bodies[name] = scenario.bodies[name].model_copy(
            update={"velocity": (0.0, v_y, 0.0), "angular_velocity": (0.0, 0.0, omega)}
        )
    model = Planar(scenario)
    mbs = model.mbs
    fixed = mbs.AddMarker(items.MarkerNodeCoordinate(
        nodeNumber=mbs.AddNode(items.NodePointGround()), coordinate=0))  # fmt: skip
    mbs.AddObject(items.ObjectConnectorCoordinate(
        markerNumbers=[fixed, model.coordinate("crank", 2)], velocityLevel=True,
        offset=rate))  # fmt: skip
    for k in (1, 2):
        mbs.AddObject(items.ObjectConnectorCoordinate(
            markerNumbers=[fixed, model.coordinate("slider", k)]))  # fmt: skip
    memory = mbs.AddNode(items.NodeGenericData(
        initialCoordinates=[0.0] * 4, numberOfDataCoordinates=4))  # fmt: skip
    stiffness = 4 / 3 / (2 * (1 - 0.3**2) / 207e9) * (0.01 * 0.0095 / 0.0005) ** 0.5
    mbs.AddObject(items.ObjectContactSphereSphere(
        markerNumbers=[model.point("slider", (0.17, 0, 0), True),
                       model.point("rod", (0.17, 0, 0), True)],
        nodeNumber=memory, spheresRadii=[0.0095, 0.01], isHollowSphere1=True,
        contactStiffness=stiffness, contactStiffnessExponent=1.5, impactModel=1,
        restitutionCoefficient=0.905))  # fmt: skip
    if sensor:
        mbs.AddSensor(items.SensorNode(
            nodeNumber=model.node["slider"], storeInternal=True,
            outputVariableType=exu.OutputVariableType.Velocity))  # fmt: skip
    mbs.Assemble()
    return model


def flexible_pendulum(n: int) -> Iterator[Measured]:
    """P2 in cables of |r' x r''| / |r'|^2 and |r'| - 1, trsim's `gerstmayr` and `engineering`."""
    from benchmarks.flexible_pendulum import SCENARIO, reference

    scenario = load(SCENARIO, [f"bodies.rod.elements={n}"])
    for step in (1e-3, 5e-4, 2.5e-4):
        mbs, nodes = cable_model(scenario.bodies["rod"], scenario.gravity)
        s = settings(2.0, step, n)
        s.linearSolverType = exu.LinearSolverType.EigenSparse
        cpu = cpu_of(lambda mbs=mbs, s=s: solved(mbs, s))
        mbs, nodes = cable_model(scenario.bodies["rod"], scenario.gravity)
        place = exu.OutputVariableType.Position
        watched = [mbs.AddSensor(items.SensorNode(
            nodeNumber=k, storeInternal=True, outputVariableType=place))
            for k in (nodes[-1], nodes[n // 2])]  # fmt: skip
        mbs.Assemble()
        s.solutionSettings.sensorsWritePeriod = 0.01
        solved(mbs, s)
        found = np.hstack([mbs.GetSensorStoredData(k)[:, 1:] for k in watched])
        error = float(np.max(np.abs(found - reference(n))))
        yield Measured(f"generalised-alpha {step:g} s", cpu, error, round(2.0 / step))


def cable_model(bar: Any, gravity: Any) -> tuple[Any, list[Any]]:
    """A cable pinned at its start, with the velocities of a rigid bar; and its nodes."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    area, moment, _ = bar.numbers
    a, b, omega = (np.array(x) for x in (bar.start, bar.end, bar.angular_velocity))
    t = (b - a) / bar.length
    nodes = []
    for k in range(bar.elements + 1):
        r = a + k / bar.elements * (b - a)
        v = np.array(bar.velocity) + np.cross(omega, r - 0.5 * (a + b))
        nodes.append(mbs.AddNode(items.NodePointSlope1(
            referenceCoordinates=[*r, *t],
            initialVelocities=[*v, *np.cross(omega, t)])))  # fmt: skip
    for ends in itertools.pairwise(nodes):
        cable = mbs.AddObject(items.ObjectANCFCable(
            physicsLength=bar.length / bar.elements, physicsMassPerLength=bar.per_length,
            physicsBendingStiffness=bar.youngs_modulus * moment,
            physicsAxialStiffness=bar.youngs_modulus * area, nodeNumbers=list(ends)))  # fmt: skip
        weight = mbs.AddMarker(items.MarkerBodyMass(bodyNumber=cable))
        mbs.AddLoad(items.LoadMassProportional(markerNumber=weight, loadVector=list(gravity)))
    ground = mbs.AddObject(items.ObjectGround(referencePosition=list(a)))
    pins = [
        mbs.AddMarker(items.MarkerBodyPosition(bodyNumber=ground, localPosition=[0.0, 0.0, 0.0])),
        mbs.AddMarker(items.MarkerNodePosition(nodeNumber=nodes[0])),
    ]
    mbs.AddObject(items.ObjectJointSpherical(markerNumbers=pins))
    mbs.Assemble()
    return mbs, nodes


PROBLEMS = {
    "slider_crank": slider_crank,
    "andrews": andrews,
    "windows": four_bars,
    "chain": rods,
    "flexible_pendulum": flexible_pendulum,
}
