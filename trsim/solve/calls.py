"""What an integrator is to the march: three functions, called by address like the elements.

STEP        b.y1 <- one step of size h from r.y, with b.K[0] = y'(t, y); returns the error, in
            units of the tolerance (<= 1 is accepted; 0 where there is no estimate; NO_STEP and more
            where no step was found, b.y1 is then nothing)
            Row 1 of K is scratch of the march once step and dense output are made
DENSE       fills P so that INTERPOLATE gives the solution inside the step; K[-1] of the method
            is y'(t + h, y1) with y1 as finally accepted, projected
INTERPOLATE y <- solution at t + theta h
CONTROL     net <- control points of the solution less y, in Bernstein's basis; where a method has none
            they are taken from values                                              spread.py
"""

from trsim.elements import signatures as types
from trsim.elements.calls import caller
from trsim.elements.contract import SCENE
from trsim.elements.packed import A1, A2, I1, f8, i8
from trsim.solve.record import BUFFERS, RECORD

NO_STEP = 10.0

#                    scene  record  buffers  setting t h
STEP = types.float64(SCENE, RECORD, BUFFERS, A1, f8, f8)
#                  scene  K   t   y   h   y1  P
DENSE = types.void(SCENE, A2, f8, A1, f8, A1, A2)
#                        P   y   theta out
INTERPOLATE = types.void(A2, A1, f8, A1)
#                    P   net
CONTROL = types.void(A2, A2)
# what locates points of sections, for runs that have some               scene  record  buffers
#                                 method t h t1 work of projection, built, event
SECTIONS = types.void(SCENE, RECORD, BUFFERS, I1, f8, f8, f8, f8, i8, i8)

# what looks at redundant rows, for runs that may have some
#                   scene  record  buffers  setting t y end of a step
LOOK = types.int64(SCENE, RECORD, BUFFERS, A1, f8, A1, i8)
# what finds the first event of a step, for runs that can have some       scene  record  buffers
#                                        setting method t h built
SEARCH = types.float64(SCENE, RECORD, BUFFERS, A1, I1, f8, f8, i8)

# a row of `methods`: addresses of step, dense output, interpolation and of `complete`, which row
# of K holds the last derivative, the power of h its error estimate falls with, whether implicit;
# the addresses of what locates points of sections, of what goes on behind corners of functions, of
# what looks at redundant rows, of what looks at rounding and of what finds events, or 0; how many
# rows of K hold derivatives at the stages of a step whose dense output is dear, or 0; the degree of
# that output, and the address of its control points, or 0; the addresses of what finds corners that sensors meet, of what tells how far beyond
# one a place is and of what goes on behind it, or 0; and of what
# keeps extremes
STEP_AT, DENSE_AT, INTERPOLATE_AT, COMPLETE_AT, LAST_AT, ESTIMATE_AT, IMPLICIT_AT = range(7)
SECTIONS_AT, MEET_AT, LOOK_AT, ROUNDING_AT, SEARCH_AT, STAGES_AT, DEGREE_AT = range(7, 14)
CONTROL_AT, CORNERS_AT, BEYOND_AT, TURN_AT, SAMPLE_AT, METHOD_WIDTH = 14, 15, 16, 17, 18, 19

call_step = caller(STEP)
call_dense = caller(DENSE)
call_interpolate = caller(INTERPOLATE)
call_control = caller(CONTROL)
call_sections = caller(SECTIONS)
call_look = caller(LOOK)
call_search = caller(SEARCH)
