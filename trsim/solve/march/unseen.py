"""Steps of DOP853 that err by more than its estimate sees.

The estimate e5^2 / sqrt(e5^2 + 0.01 e3^2) of two embedded orders has two holes, in which the error
at the end of a step is about half of e3:

* A decay with h rho of 5.4 to 6, where e5 passes zero: what is left of a decay that has just begun,
  as that of sliding at the end of the ramp of friction, turns it round, and the force with it.
* A corner of friction in a joint, of which stages lie on both sides: e5 may be anything then, and
  next to nothing by chance.
"""

from math import sqrt

from trsim.assemble.equations import call_all, set_poses
from trsim.elements.contract import Load
from trsim.kernels.lazy import internal
from trsim.laws.friction import CODES, branch_of
from trsim.solve.march.norm import squares
from trsim.solve.methods.auto import explicit_rate
from trsim.solve.methods.dop853 import FIFTH, THIRD

UNSEEN_FROM, UNSEEN_TO = 4.8, 6.4  # h rho: where the first hole is
# of that estimate: the error in a hole at the end of a step, and inside it in the first one
AT_END, INSIDE = 0.5, 3.0
CHANCE = 0.1  # of e3: less is left of e5 in a step over a corner by chance alone
CORNERED = CODES["modified_coulomb"]


@internal
def errs_unseen(s, r, b, h):
    """Whether a step h, just landed, errs by more than is allowed in one of these."""
    third, counted = squares(b.K[THIRD], b.weight, 0, b.weight.size), 0
    for c in range(b.weight.size):
        counted += int(b.weight[c] != 0.0)
    error = h * sqrt(third / counted) if counted > 0 else 0.0
    if INSIDE * error > 1.0 and UNSEEN_FROM < h * explicit_rate(s, r, b, h) < UNSEEN_TO:
        return True
    if s.rubbing.shape[0] == 0 or not AT_END * error > 1.0:
        return False
    fifth = squares(b.K[FIFTH], b.weight, 0, b.weight.size)
    return fifth < CHANCE**2 * third and corner_passed(s, r, b)


@internal
def corner_passed(s, r, b):
    """Whether friction of a joint is on another branch at the end of the step than at its start."""
    passed = False
    put_branches(s, r.t, b.y1, s.rub_branch[1])
    put_branches(s, r.t, r.y, s.rub_branch[0])
    for k in range(s.rubbing.shape[0]):
        passed = passed or s.rub_branch[0, k] != s.rub_branch[1, k]
    set_poses(s, b.y1)
    return passed


@internal
def put_branches(s, t, y, found):
    """The branches that frictions of joints are on at y; 0 of laws without corners."""
    set_poses(s, y)
    call_all(s, s.load, t)
    for k in range(s.rubbing.shape[0]):
        e, law, first = s.rubbing[k, 0], s.rubbing[k, 4], s.rubbing[k, 5]
        found[k] = 0.0
        if s.con[e, law] == CORNERED:
            found[k] = branch_of(Load(s, e).slip, s.par[e, first + 1], s.par[e, first + 2])
