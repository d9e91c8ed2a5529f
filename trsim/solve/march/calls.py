"""What an integrator is to the march: three functions, called by address like the elements.

STEP        b.y1 <- one step of size h from r.y, with b.K[0] = y'(t, y); returns the error, in
            units of the tolerance (<= 1 is accepted; 0 where there is no estimate; NO_STEP and more
            where no step was found, b.y1 is then nothing)
            Row 1 of K is scratch of the march once the step is made: DENSE of an explicit method
            does not read it, that of an implicit one is made before
DENSE       fills P so that INTERPOLATE gives the solution inside the step; `ends` are y and y1,
            K[-1] of the method is y'(t + h, y1) with y1 as finally accepted, projected
INTERPOLATE y <- solution at t + theta h
RATE        rate <- y' of what is slow, theta of a step h: that of its dense output P, or at the end
            of the step just made (AT_END of settle.py) that of its stages
SOFTEN      c <- (mu - J)^-1 c with what the last step was solved with; returns mu, 0: none is there
BOOK        z of b.y1 <- works of the step of length h whose end was just brought to the rows, for
            methods that know its power only then
CONTROL     net <- control points of the solution less y, in Bernstein's basis; where a method has
            none they are taken from values                                   spread.py
"""

from typing import TYPE_CHECKING

import numpy as np

from trsim.elements.contract import SCENE
from trsim.kernels import signatures as types
from trsim.kernels.calls import caller
from trsim.kernels.packed import A1, A2, I1, f8, i8
from trsim.solve.march.record import BUFFERS, RECORD, SETTINGS

if TYPE_CHECKING:
    from numpy.typing import NDArray

NO_STEP = 10.0

#                    scene  record  buffers  settings  t   h
STEP = types.float64(SCENE, RECORD, BUFFERS, SETTINGS, f8, f8)
#                  scene  K   t   h   ends P
DENSE = types.void(SCENE, A2, f8, f8, A2, A2)
#                        P   y   theta out
INTERPOLATE = types.void(A2, A1, f8, A1)
#                 K   P   h   theta rate
RATE = types.void(A2, A2, f8, f8, A1)
#                      scene  record  buffers  c
SOFTEN = types.float64(SCENE, RECORD, BUFFERS, A1)
#                 scene  record  buffers  h
BOOK = types.void(SCENE, RECORD, BUFFERS, f8)
#                    P   net
CONTROL = types.void(A2, A2)
# what locates points of sections, for runs that have some
#                     scene  record  buffers  method event
SECTIONS = types.void(SCENE, RECORD, BUFFERS, I1, i8)

# what looks at redundant rows, for runs that may have some
#                  scene  record  buffers  settings  t   end of a step
LOOK = types.int64(SCENE, RECORD, BUFFERS, SETTINGS, f8, i8)
# what finds the first event of a step, for runs that can have some
#                      scene  record  buffers  settings method
SEARCH = types.float64(SCENE, RECORD, BUFFERS, SETTINGS, I1)

# what finds one event that watches a channel, for runs that have such
#                     scene  record  buffers  method event end of what is searched
SOUND = types.float64(SCENE, RECORD, BUFFERS, I1, i8, f8)

# a row of `methods`, made by `method_row`: what the march must know of a method and of a run, in
# whole numbers; an address is 0 where nothing of that kind is to be done
FIELDS = (
    "step", "dense", "interpolate",  # addresses of the three functions
    "complete",  # and of what makes a trial step an accepted one
    "last",  # the row of K with the derivative at the end of a step
    "estimate",  # the power of h that the error estimate falls with
    "implicit",  # whether it is
    "stages",  # rows of K with derivatives at the stages of a step whose dense output is dear, or 0
    "degree", "control",  # of the dense output, and the address of its control points
    "sections",  # what locates points of sections
    "meet",  # what goes on behind corners of functions
    "look",  # what looks at redundant rows
    "rounding",  # what looks at rounding
    "search",  # what finds events
    "sound",  # and those that watch channels
    "corners", "beyond", "turn",  # what finds corners that sensors meet, how far, and goes on
    # what keeps extremes, what does where samples end, and what looks between two of them
    "sample", "finish", "between",
    "passes",  # what notes steps past places where branches of the motion may meet
    "inside",  # what tells the error of accelerations inside a step, as `step` does that of its end
    "rate", "soften",  # what brings to rest what is stiff in a state             settle.py
    "book",  # what books works at the end of a step
    "poles",  # what finds where a function has no value
    "land", "measure_in",  # what brings an end to the rows, what measures inside a step
    "stiff",  # what looks at how stiff the mechanism is, for methods that ask     stiffness.py
)  # fmt: skip
(
    STEP_AT, DENSE_AT, INTERPOLATE_AT, COMPLETE_AT, LAST_AT, ESTIMATE_AT, IMPLICIT_AT, STAGES_AT,
    DEGREE_AT, CONTROL_AT, SECTIONS_AT, MEET_AT, LOOK_AT, ROUNDING_AT, SEARCH_AT, SOUND_AT,
    CORNERS_AT, BEYOND_AT, TURN_AT, SAMPLE_AT, FINISH_AT, BETWEEN_AT, PASSES_AT, INSIDE_AT,
    RATE_AT, SOFTEN_AT, BOOK_AT, POLES_AT, LAND_AT, MEASURE_IN_AT, STIFF_AT,
) = range(len(FIELDS))  # fmt: skip


def method_row(**values: int) -> "NDArray[np.int64]":
    """A row of `methods` from its fields by name; those not given are 0."""
    unknown = set(values) - set(FIELDS)
    if unknown:
        raise TypeError(f"no field {sorted(unknown)} in a row of methods")
    return np.array([values.get(name, 0) for name in FIELDS], np.int64)


call_step = caller(STEP)
call_dense = caller(DENSE)
call_interpolate = caller(INTERPOLATE)
call_control = caller(CONTROL)
call_book = caller(BOOK)
call_rate = caller(RATE)
call_soften = caller(SOFTEN)
call_sections = caller(SECTIONS)
call_look = caller(LOOK)
call_search = caller(SEARCH)
call_sound = caller(SOUND)
