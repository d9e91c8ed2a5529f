"""Everything the compiled code sees of a mechanism: the model's constants and the workspace.

Frames 0..n-1, 0 the ground.  State of the motion, one vector

    y = [q (n_q) | v (n_v) | z (n_z)]

planar (d = 3): q = x, y, angle and v = their rates of each moving body;
spatial (d = 6): q = position and quaternion (7), v = velocity and body-axes angular velocity (6);
nodes of beams follow, each with place and slope and their rates.
Only `poses` in assemble/equations.py knows this; kernels see poses, twists and joint coordinates.
"""

from __future__ import annotations

from typing import Any

from trsim.kernels.packed import A1, A2, I1, I2, T2, T3, T6, T9, T12, Packed, f8, i8

NONE, BAUMGARTE, PROJECTION = 0, 1, 2  # stabilisation
OUTSIDE, LENGTH, ANGLE, SPEED, RATE, MAGNITUDE = 0, 1, 2, 3, 4, 5  # scale_kind
N_STORED = 3
N_MEM = 4  # columns of `mem` that all elements have, see contract.py
DELAYED = 64  # rows whose pivots may wait for those of hubs, at most
COMPONENTS = {".x": 0, ".y": 1, ".z": 2}  # of a channel of three, in its name


class Model(Packed):
    """A mechanism as numbers.  Nothing in it changes during a run.

    Its type is the same for every scenario, so the solver compiles once per installation.
    """

    d: i8  # unknowns of a rigid body: 3 planar, 6 spatial
    d_node: i8  # unknowns of a node of a beam: 4 planar, 6 spatial
    n: i8  # frames
    n_r: i8  # of these the ground and the rigid bodies; nodes of beams follow
    n_q: i8
    n_v: i8
    q_node: i8  # where the nodes begin in q
    v_node: i8  # and in v
    n_z: i8
    m: i8  # constraint rows in the solve
    unequal: i8  # 1: masses or moments of inertia are so unequal that multipliers are too coarse
    n_s: i8  # entries of S
    n_mem: i8  # columns of mem
    n_out: i8  # output columns
    size: f8  # m, the mechanism's
    reach: f8  # m, the largest arm of a body
    mass: A1  # (n)
    inertia: T9  # (n, 9) body axes
    mass_inverse: A1  # (n) 0 for the ground
    light: I1  # frames of bodies without mass or without an inertia                    light.py
    lacking: A2  # (n_light, 10) what these are solved with: a mass, an inertia in body axes
    lightened: i8  # address of what takes that back, or 0
    inertia_inverse: T9  # (n, 9) body axes; planar: [8] is 1 / Izz
    axes: T9  # (n, 9) rotation of a node of a beam as drawn, row by row
    depth: A1  # (n) z of the centre of mass in a planar scene, m
    on_beams: I1  # addresses of what the equations ask of beams; 0 without  on_beams.py
    beam: I2  # (n_beams, 4) first frame, nodes, first row of band, first element  beams.py
    band: A2  # (2 nodes, 4) its mass matrix as L D L^T: 1 / D, three entries of L below
    consistent: A2  # (2 nodes, 4) the same as it is: diagonal and three entries below
    across: A2  # (pairs on beams, 4) M^-1 between their nodes: places, slopes
    con: I2  # (N, n_con) where               elements/contract.py
    par: A2  # (N, n_par) how much
    tab: A1  # everything of variable length   laws/functions.py
    turn: I2  # (n_turn, 4) planar joint angles: s, i, j, sign of the axis
    parallel: A1  # (n_turn) their values where the axes of both bodies are parallel
    force: I2  # (kinds, 3) kernel address, first row, end row
    constraint: I2
    coordinate: I2
    gaps: I2
    corners: I2
    energy: I2
    stiffness: I2
    measure: I2
    load: I2
    rub: I2
    strike: I2
    row_start: I1  # (m+n_d+1) lines of J of a row: one per frame it names  assemble/pattern.py
    line_row: I1  # (lines) whose they are
    line_frame: I1  # (lines) their frames, the ground too
    redundant: I2  # (n_d, 2) rows left out of the solve: row e, which of its rows
    row_unit: A1  # (m+n_d) what makes the opening of a row relative: size, or 1 rad
    frame_start: I1  # (n+1) slots of a frame: one per row that touches it, the ground has none
    slot_row: I1  # (slots) its row
    slot_line: I1  # (slots) its line of J
    hub: I1  # (n) first unknown of a body whose motion is one of the solve, after the rows; or -1
    entry: I1  # (pairs) the place in S that two slots of one frame, or slot and hub, add to
    column_start: I1  # (n_x+1) places of the column of S and of L that is eliminated k-th
    row: I1  # (places) their unknowns, that of the diagonal first: m rows, then d of each hub
    target: I1  # (updates) the place that two entries of one column of L are taken from
    derivative: i8  # address of the equations of motion
    poses: i8  # of what fills X, V, S and z, and of what fills the rows too where velocities ask
    poses_and_rows: i8
    newton_step: i8  # of what takes a place nearer to the rows, and a state onto them
    on_rows: i8
    measured: i8  # of what measures all channels                     outputs.py
    beside: i8  # of what finds limits where rows depend on each other     beside.py
    near: f8  # pivot below which it is asked; 0: where rows do depend on each other only
    near_rows: f8  # the same of what is measured
    looped: I1  # rigid bodies in kinematic loops    assemble/loops.py
    judged: I2  # (n, 2) frames of what judges how far one is turned against the other: bushings
    tolerance: f8  # asked for, of the units of the error norm
    shared_out: i8  # address of what shares loads between redundant rows, or 0     least_norm.py
    plain: i8  # address of what leaves Baumgarte's feedback out of what is measured, or 0
    stabilisation: i8  # NONE, BAUMGARTE, PROJECTION
    alpha: f8  # 1/s, Baumgarte: Phi'' + 2 alpha Phi' + beta^2 Phi = 0
    beta: f8
    scale_kind: I1  # (n_y) which unit weighs an entry of y in the error norm
    scale: A1  # (n_y) lever or magnitude that goes with it
    contact: I1  # (n_contacts) row e of each element with a gap
    contact_par: A2  # (n_contacts, 8) ContactNumbers of contract.py
    contact_state: I1  # (n_contacts) first entry of z to reset at a touch, or -1
    contact_states: I1  # (n_contacts) how many there are
    contact_width: I1  # (n_contacts) its output columns
    contact_impact: I1  # (n_contacts) 1: a touch takes no time     solve/march/impacts.py
    contact_angle: I1  # (n_contacts) among them: first of the eccentricity's two, or -1
    wanted: I1  # (N) first output column of a row, or -1
    silent: I1  # columns of forces that do not act
    vector: I1  # first columns of the vectors whose magnitudes have extremes
    sought: I1  # (n_k) columns, and behind all those such magnitudes, with extremes inside steps
    kin: I1  # (n_k) those of one kind have one number
    natural: I2  # (kinds, 3) powers of mass, size and speed that make a unit of each; 0: unknown
    lever: A1  # (n_k) what brings them to one unit
    least: A1  # (n_k) what they are never below
    shared: I1  # columns of forces and moments, which rows may share between them
    joint_out: I2  # (n_j, 4) reactions: row e, first of its rows in con, how many, column
    watch: I2  # (n_w, 3) user events: entry of S or -1 for t, direction, how often   events.py
    # (n_w, 2) the value that is crossed; how far it must be left before it counts again
    watch_at: A2
    heard: I1  # (n_w) output columns that user events watch, -1 of others; empty without any
    hear: i8  # address of what measures them, or 0
    feature: I2  # (n_features, 7) functions with corners                   assemble/features.py
    jump: A2  # (n_instants, 2) of the place and the rate of a motion there       jumps.py
    instant: A1  # when those are met that the time alone decides
    rated: I2  # (n, 2) entries of S that hold the rate of another: own, of which
    wound: I1  # entries of S known up to full turns: angles not of bodies in the plane
    steep: i8  # how many motions of drives may be steep between their corners
    sensed: I2  # (n, 3) sensors that meet corners
    slots: i8  # the most that a function has whose corners they meet
    held: I1  # (corners) where in tab it stands what each is held on
    # (n, 6) what rubs in joints: its row, that of the joint, where rows of that begin in con, how
    # many; the columns of its law in con and of the numbers of that in par
    rubbing: I2
    rubbed_at: i8  # address of what finds their friction forces; 0 where nothing rubs   rubbing.py
    rubs_with: i8  # and of those that go with given multipliers
    on_features: I1  # address of what holds functions on their pieces; 0 without such functions
    travel: I2  # (n_contacts + n_w, 2) kind of each gap, the instance it lies at   travel.py
    kink: A1  # (n_contacts + n_w) |gap| from which on it may be on another branch
    section: I2  # (n_sections, 6) Poincare sections              assemble/sections.py
    pole: I2  # (n, 4) what of functions may have no value                 assemble/poles.py
    pole_slots: i8  # the most that one of them has
    # (n, 2) functions with waves, where a section looks at what they move: offset in tab, row of
    # the drive whose motion it is, or -1
    wave: I2
    wave_slots: i8  # of the longest of them
    swings_at: i8  # address of how fast they swing; 0 where nothing asks for it   assemble/waves.py
    pulse: I2  # (n, 2) the same of loads and drives that may have short pulses
    pulse_slots: i8
    beats_at: i8  # address of how fast these go
    section_at: A2  # (n_sections, 2) s: before it no points; period, or 0
    jumps: i8  # entry of z with the work done at user events, or -1
    column_energy: i8  # first output column of the energy book

    def replaced(self, **changes: Any) -> Model:
        """A copy with some fields replaced."""
        return Model(self, **changes)


class Scene(Model):
    """A model and the workspace of its equations; holds the last evaluation."""

    element: A2  # (7, 12) coordinates, rates and forces of one element of a beam; room
    tangent: A2  # (12 n_elements, 12) its stiffness against places and slopes
    viscous: A2  # (12 n_elements, 12) its damping against their rates
    G: T6  # (n, 6) slope of a node, and its rate; world axes
    Q: T3  # (n, 3) elastic force along the slope of a node, N*m
    X: T12  # (n, 12) position of the centre of mass, rotation matrix row by row
    V: T6  # (n, 6) velocity, angular velocity, world axes
    A: T6  # (n, 6) their rates
    S: T2  # (n_s, 2) joint coordinates and sensors: value and rate
    branch: A1  # (n_s) value at the last accepted point: which turn an angle is on
    z: A1  # (n_z) quadratures and element states
    zd: A1  # (n_z) their rates
    mem: A2  # (N, n_mem) what elements remember; part of the record of a run
    F: T6  # (n, 6) force, moment about the centre of mass, world axes
    # of the m rows of the solve, then of the redundant ones, which are only looked at
    phi: A1  # (m+n_d)
    phi_t: A1  # (m+n_d)
    J: T6  # (lines, 6) a row against the twist of a frame it names
    gamma: A1  # (m+n_d)
    lam: A1  # (m+n_d) multipliers; 0 of the redundant
    B: T6  # (slots, 6) rows of J in the axes of the solve
    W: T6  # (slots, 6) M^-1 B^T
    value: A1  # (places) S = J M^-1 J^T, then its factors
    first: A1  # (n_x) its diagonal, in elimination order
    through: A1  # (m) what of the diagonal acts through hubs
    # of rows whose pivot waits for the hubs (assemble/linear.py), R at most: their number, and
    # when they are eliminated; Z; the Cholesky factor of G; what is left of them; room
    delayed: I1  # (1 + R)
    delayed_columns: A2  # (R, n_x)
    delayed_factor: A2  # (R, R)
    delayed_pivot: A1  # (R)
    delayed_room: A1  # (R)
    x: A1  # (n_x) right-hand side, then solution
    r: A1  # (n_x) refinement
    r2: A1  # (n_x)
    aside: A2  # (10, n_y or n_v+m+1) states and accelerations beside this one   beside.py
    root: A2  # (3, n_x) sigma at the ends of the last step and of this one    solve/march/passes.py
    part_root: A2  # (3, n_x) the same of parts of a step
    kept_rows: A2  # (4, 6 slots) B and the factors of two places, and of both ends of a step
    kept_factors: A2  # (4, places)
    kept_roots: A2  # (2, n_x) sigma of those two places
    own: A2  # (2, 6 n) what a row has of its own
    given_back: A2  # (n_light, 6) accelerations that make up for what light bodies have too much
    stress: A2  # (n_d, n_x) self-stresses of the redundant rows             least_norm.py
    gram: A2  # (n_d + 2, n_d) their products, room, and the largest square of one
    # where something rubs, else without rows
    pressed: T6  # (N, 6) reaction of its joint: force, and moment about the joint, world axes
    unpressed: T6  # (N, 6) the same without friction
    loads: A2  # (N, 10) Load of contract.py
    rubbed: A1  # (N) friction force along the sliding speed
    by_rubbing: A2  # (n, 6 n) derivatives of the reactions against the friction forces
    rub_room: A2  # (n + 4, n or 6) a small system
    rub_branch: A2  # (2, n) branches of their laws at both ends of a step
    before_rubbing: T6  # (n, 6) F of all other forces
    moved: T6  # (n, 6) what multipliers do to the bodies, axes of the solve
    free: T6  # (n, 6) accelerations without constraints, axes of the solve
    gap: T2  # (N, 2) penetration and its rate
    blow: T12  # (3, 12) wrenches of impulses of 1 of what strikes
    corner: T2  # (N, 2) how far an element has left its branch, and the branch it goes to
    left: A1  # (N) the largest such value since it was cleared
    slid: T6  # (N, 6) how an element slides that rubs fully, m/s, and how at the start of the step
    E: A1  # (N_STORED) stored energy
    swing_box: A2  # (slots, 4) scratch: ranges of the parts of one of them
    out: A1  # (n_out) one output row
    # [0] how the last factorisation went, [1] evaluations, [2] factorisations,
    # [3] evaluations with contradictory constraints since the last accepted step,
    # [4] evaluations of the step at hand that took a limit where branches meet,
    # [5] 1: what is evaluated lies inside a step, and will be measured,
    # [6] factorisations of the step at hand with a small pivot,
    # [7] 1 + the row of what rubs, where the last evaluation found no friction, or several,
    # [8] evaluations whose friction is not proved to be the only one
    status: I1


def workspace(model: Model) -> Scene:
    """A scene of the model: itself if it is one, which keeps the branches of its angles."""
    return model if isinstance(model, Scene) else scene(model)


def scene(model: Model) -> Scene:
    """Fresh workspace for a model."""
    import numpy as np

    n, m, n_x, slots = model.n, model.m, len(model.column_start) - 1, len(model.slot_row)
    rows = m + len(model.redundant)
    elements = int(np.sum(model.beam[:, 1] - 1)) if len(model.beam) else 0
    loops = 1 if model.near_rows > 0.0 else 0
    waiting = min(m, DELAYED) if n_x > m else 0
    shared = len(model.redundant) if model.shared_out else 0
    rubs = len(model.rubbing)
    whose = len(model.con) if rubs else 0
    n_y = model.n_q + model.n_v + model.n_z
    shapes = (
        (("X",), (n, 12)),
        (("V", "A", "F", "G", "moved", "free"), (n, 6)),
        (("Q",), (n, 3)),
        (("element",), (7, 12)),
        (("tangent", "viscous"), (12 * elements, 12)),
        (("S",), (max(model.n_s, 1), 2)),
        (("branch",), (max(model.n_s, 1),)),
        (("z", "zd"), (model.n_z,)),
        (("mem",), (len(model.con), model.n_mem)),
        (("gap", "corner"), (len(model.con), 2)),
        (("left",), (len(model.con),)),
        (("slid",), (len(model.con), 6)),
        (("blow",), (3, 12)),
        (("phi", "phi_t", "gamma", "lam"), (rows,)),
        (("J",), (len(model.line_row), 6)),
        (("B", "W"), (slots, 6)),
        (("value",), (len(model.row),)),
        (("first", "x", "r", "r2"), (n_x,)),
        (("through",), (m,)),
        (("delayed_columns",), (waiting, n_x)),
        (("delayed_factor",), (waiting, waiting)),
        (("delayed_pivot", "delayed_room"), (waiting,)),
        (("aside",), (10, max(n_y, model.n_v + m + 1))),
        (("root", "part_root"), (3 * loops, n_x)),
        (("kept_rows",), (4 * loops, 6 * slots)),
        (("kept_factors",), (4 * loops, len(model.row))),
        (("kept_roots",), (2 * loops, n_x)),
        (("own",), (2 * loops, 6 * n)),
        (("given_back",), (len(model.light), 6)),
        (("stress",), (shared, n_x)),
        (("gram",), (shared + 2, shared)),
        (("pressed", "unpressed"), (whose, 6)),
        (("loads",), (whose, 10)),
        (("rubbed",), (whose,)),
        (("by_rubbing",), (rubs, 6 * rubs)),
        (("rub_room",), (rubs + 4, max(rubs, 6) if rubs else 0)),
        (("rub_branch",), (2, rubs)),
        (("before_rubbing",), (n if rubs else 0, 6)),
        (("E",), (N_STORED,)),
        (("swing_box",), (max(model.wave_slots, model.pulse_slots), 4)),
        (("out",), (max(model.n_out, 1),)),
    )
    made = Scene(
        model,
        {name: shape for names, shape in shapes for name in names},
        tab=model.tab.copy(),  # scratch, and what functions are held on
        watch_at=model.watch_at.copy(),  # clocks are started in it
        status=np.zeros(9, np.int64),
        delayed=np.zeros(1 + waiting, np.int64),
    )
    made.X[:, 3::4] = 1.0
    made.X[:, 2] = model.depth
    made.corner[...] = made.left[...] = -1.0
    return made


def carried(work: Scene, model: Model) -> Scene:
    """A scene of another stage of the same run: memory, branches and counters go on in it."""
    kept = {name: getattr(work, name) for name in ("mem", "branch", "status", "watch_at")}
    return Scene(scene(model), **kept)
