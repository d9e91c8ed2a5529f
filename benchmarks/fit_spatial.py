"""Spatial thrust reverser: stiffness of actuators and rails fitted to the study's nine peaks.

A rigid fairing at rest under the loads W(t) of five chains, on rails (y, z) and actuators (x):

    (K_r + k A^T A) u = W + k A^T delta        u = (displacement, rotation) of the leading edge
    R = k (A u - delta) = R_sync - K delta     hold-back of each actuator
    K = k (1 - k A (K_r + k A^T A)^-1 A^T)

delta_j(t) = (v_j - v) t is how far actuator j is ahead.  A peak is the largest R over the stroke
and over the speeds 418, 419, 421 and 422 mm/s of one actuator.  What a chain does to the fairing is
read off the planar run at 0.42 m/s: the negative of what its guide and its drive do.

The nine peaks are matched by k, k_y and k_z alone (Gauss-Newton on their logarithms); places,
angles and unevenness of the gas load are those of spatial_mechanism.yaml.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.measure import SCENARIOS, run

Array = NDArray[np.float64]
SPEED, ODD = 0.420, (0.418, 0.419, 0.421, 0.422)  # m/s
CHI = np.radians([-72.0, -36.0, 0.0, 36.0, 72.0])
UNEVEN = np.array([2.0, 1.0, 0.0, -1.0, -2.0])  # times a hundredth of the gas load
SUPPORT = 0.459  # m, radius of the chains' origins
CENTRE = (0.400, 0.270)  # m, of the planar fairing: aft of the leading edge, above the origin
ACTUATORS = 0.82 * np.array([[np.sin(a), np.cos(a)] for a in np.radians([-50.0, 0.0, 50.0])])
RAILS = [(x, y, 0.0) for y in (-0.72, 0.72) for x in (0.0, 0.30)]
STUDY = np.array([[2258, 1370, 2017], [2782, 2310, 2712], [2068, 1348, 2227]], float)  # N
ROUNDED = np.array([1.6e6, 0.8e6, 2.4e6])  # N/m: of an actuator, of a slider in y and in z
NAMES = ("actuator", "rail y", "rail z")


class Loads(NamedTuple):
    """Times, s, and what the chains do to the fairing there: (n, 6) about its leading edge."""

    t: Array
    wrench: Array


def planar() -> Any:
    """The run of one chain, ideal joints and drive, from the touch of the lug on."""
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import load

    sets = (f"parameters.speed={SPEED}", f"solver.end=0.5/{SPEED}", "output.every=1 ms")
    scenario = load(SCENARIOS / "thrust_reverser" / "ideal.yaml", sets)
    return run(scenario, assemble(scenario))


def loads(chain: Any, uneven: float = 0.01) -> Loads:
    """Of five chains, from the planar run; after the impact of the lug, where rest is meant."""
    late = chain.rows[:, 0] > 0.2 / SPEED
    place = chain.columns["guide.reaction"]
    reaction = chain.rows[late][:, 1 + place : 4 + place]
    moment = chain.rows[late][:, 1 + chain.columns["guide.reaction_moment"] + 2]
    force = np.stack([chain.channel("actuator.force")[late], -reaction[:, 1]])  # aft, outward
    total = np.zeros((late.sum(), 6))
    for chi, share in zip(CHI, 1.0 + uneven * UNEVEN, strict=True):
        e_r, e_t = np.array([0, np.sin(chi), np.cos(chi)]), np.array([0, -np.cos(chi), np.sin(chi)])
        F = np.outer(force[0], [1, 0, 0]) + np.outer(force[1], e_r)
        r = np.array([CENTRE[0], 0, 0]) + (SUPPORT + CENTRE[1]) * e_r
        total += share * np.hstack([F, np.cross(r, F) - np.outer(moment, e_t)])
    return Loads(chain.rows[late, 0], total)


def of_place(direction: tuple[float, ...], r: tuple[float, ...]) -> Array:
    """Row that takes u to the displacement of a place along a direction."""
    return np.hstack([direction, np.cross(r, direction)])


PUSH = np.array([of_place((1, 0, 0), (0.02, y, z)) for y, z in ACTUATORS])  # A
SIDEWAYS = np.array([of_place((0, 1, 0), r) for r in RAILS])
UP = np.array([of_place((0, 0, 1), r) for r in RAILS])


def compliance(stiffness: Array) -> Array:
    """(K_r + k A^T A)^-1 of (k, k_y, k_z)."""
    k, k_y, k_z = stiffness
    return np.linalg.inv(k_y * SIDEWAYS.T @ SIDEWAYS + k_z * UP.T @ UP + k * PUSH.T @ PUSH)


def coupling(stiffness: Array) -> Array:
    """K, N/m: how much less each actuator holds back where each is ahead."""
    k = stiffness[0]
    return k * (np.eye(3) - k * PUSH @ compliance(stiffness) @ PUSH.T)


def forces(stiffness: Array, by: Loads, speeds: Array) -> Array:
    """R(t), N: (n, 3), of actuators at the given speeds."""
    together = stiffness[0] * by.wrench @ compliance(stiffness) @ PUSH.T
    return together - np.outer(by.t, speeds - SPEED) @ coupling(stiffness)


def peaks(stiffness: Array, by: Loads) -> Array:
    """Largest R, N: [odd actuator, actuator]."""
    odd = [[SPEED + (v - SPEED) * np.eye(3)[j] for v in ODD] for j in range(3)]
    return np.array([np.max([forces(stiffness, by, v).max(0) for v in of], 0) for of in odd])


def slopes(stiffness: Array, by: Loads) -> Array:
    """N per unit of the logarithm of each stiffness: (9, 3)."""
    step = 1e-4
    up, down = (
        [peaks(stiffness * np.exp(sign * step * e), by).ravel() for e in np.eye(3)]
        for sign in (1, -1)
    )
    return (np.array(up) - np.array(down)).T / (2 * step)


def misfit(stiffness: Array, by: Loads) -> Array:
    """Of the nine peaks, N."""
    return (peaks(stiffness, by) - STUDY).ravel()


def fitted(by: Loads, start: Array = ROUNDED) -> Array:
    """The stiffnesses of least squares, by Gauss-Newton with steps halved until they help."""
    k = start.copy()
    for _ in range(50):
        r = misfit(k, by)
        step = np.linalg.lstsq(slopes(k, by), -r, rcond=None)[0]
        step /= max(1.0, np.abs(step).max() / 0.5)
        while np.sum(misfit(k * np.exp(step), by) ** 2) > r @ r and np.abs(step).max() > 1e-9:
            step /= 2
        k = k * np.exp(step)
        if np.abs(step).max() < 1e-8:
            break
    return k


def told(label: str, k: Array, by: Loads) -> None:
    """Print a set of stiffnesses, its peaks, its misfit and what a tenth more of each does."""
    print(f"\n  {label}: " + ", ".join(f"{n} {x:.3g} N/m" for n, x in zip(NAMES, k, strict=True)))
    together = forces(k, by, np.full(3, SPEED)).max(0)
    print("  synchronous " + " ".join(f"{x:7.0f}" for x in together))
    for j, (ours, theirs) in enumerate(zip(peaks(k, by), STUDY, strict=True)):
        print(f"  actuator {j + 1} odd" + " ".join(f"{x:7.0f}" for x in ours)
              + "   study" + " ".join(f"{x:7.0f}" for x in theirs))  # fmt: skip
    r = misfit(k, by)
    print(f"  misfit: rms {np.sqrt(np.mean(r**2)):.0f} N, largest {np.abs(r).max():.0f} N")
    print("  K, 1e5 N/m:", "  ".join(str(np.round(row / 1e5, 2)) for row in coupling(k)))
    J = slopes(k, by)
    for name, column in zip(NAMES, J.T, strict=True):
        print(f"  {name} 10 % stiffer, N:", np.round(0.1 * column).astype(int))
    s = np.sqrt(r @ r / (len(r) - 3) * np.diag(np.linalg.inv(J.T @ J)))
    print("  standard error of each stiffness, %:", np.round(100 * s).astype(int))


def main() -> None:
    by = loads(planar())
    told("fitted", fitted(by), by)
    told("rounded, as used", ROUNDED, by)


if __name__ == "__main__":
    main()
