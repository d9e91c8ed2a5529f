"""Cases and words that several statements of the study rest on."""

DEGREE = 3.141592653589793 / 180.0
LATCH = "@latch_angle=0.0..1.9"  # rad
PUSHED = "@latch_angle=0.2..1.5"
LAST = "@latch_angle=1.22..1.9"  # and as far as the static path goes
UNDER_WAY = "@opening=0.35..1.66"  # without the start, where nothing moves yet
TOP, LATE = "@latch_angle=0.2..1.6", "@latch_angle=1.22..1.65"
HANDS = (("inner handle", "lift_inner"), ("outer handle", "lift_outer"))
PRESSED = (("inner handle", "lift_inner_op"), ("outer handle", "lift_outer_op"))
STEPS = tuple((f"step {stair}", f"running,foot=0mm,stair={stair}") for stair in (1, 2, 3, 4, 5, 6))
MOTION = (("static path", "path_inner"), ("motion", "lift_inner"))
MOTION_OP = (("static path", "path_inner_op"), ("motion", "lift_inner_op"))
FIRST = "begins:fwd_guide.normal_force@latch_angle=0.01..1.9"
CROSSES = "turns:handle.force@latch_angle=0.5..1.9"
