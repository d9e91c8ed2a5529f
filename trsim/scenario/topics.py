"""Words that an engineer asks for and that are no key: what there is for them, and where.

A word in backticks is one that `trsim explain` knows.
"""

TOPICS = {
    # --- what bodies and bars do
    "torsion": (
        "A torsional spring on a joint is a `torsion_spring`; between two places, a `bushing` "
        "with `rotational_stiffness`. The torsion that a rigid body carries at a station is the "
        "component z of the moment of a `section`. Bars that bend (`ancf_cable`) have no "
        "torsion: what would twist one is refused."
    ),
    "shear": (
        "The shear force that a rigid body carries at a station is `shear` of a `section`; a "
        "pin tells it as its `reaction`. Bars that bend (`ancf_cable`) do not shear: they are "
        "for bars longer than about eight times their thickness."
    ),
    "bending": (
        "Bars that bend are an `ancf_cable`, or a rigid body with `flexible`. The bending "
        "moment that a rigid body carries at a station is `bending` of a `section`."
    ),
    "buckling": (
        "Bars that bend (`ancf_cable`) buckle. `method: static_path` of `solver` follows a load "
        "up to the place where a column gives way, and names it; `equilibrium` of `initial` "
        "refuses a bar beyond its buckling load that could go to either side: a small load to "
        "one side tells it where to go."
    ),
    "stress": (
        "Stresses inside a body are not computed. A `section` tells the force and the moment "
        "from which they follow, and `shear` and `bending` of it."
    ),
    "weight": (
        "`gravity` gives all bodies their weight. What they weigh together, and where, is said "
        "by `totals` and by `trsim check`."
    ),
    "vibration": (
        "`trsim check --modes` tells frequencies, damping and shapes of small motions at the "
        "start; `trsim report --spectrum` the spectrum of a channel."
    ),
    "resonance": "`trsim check --modes` tells the frequencies of small motions at the start.",
    "equilibrium": (
        "`trsim statics` finds where a mechanism rests; `equilibrium` of `initial` begins a run "
        "there; `method: static_path` of `solver` follows it along a motion."
    ),
    # --- joints
    "hinge": (
        "A hinge is a `revolute` joint; with two bearings a `shaft`; with play, one with a "
        "`clearance`."
    ),
    "pin": "A pin is a `revolute` joint; with play, one with a `clearance`.",
    "bearing": (
        "A bearing is a `revolute` joint, two of them on a shaft are a `shaft`; one with play "
        "has a `clearance`; an elastic one is a `bushing`."
    ),
    "ball": (
        "A ball joint is a `spherical` joint. A ball that rolls, or touches, is one of a "
        "`surface_contact`."
    ),
    "slider": "A slide is a `prismatic` joint; one that may turn, a `cylindrical` one.",
    "slide": "A slide is a `prismatic` joint; one that may turn, a `cylindrical` one.",
    "rod": (
        "A rod without mass between two balls is a `link`; a rod with mass is a `rigid_body`; "
        "one that bends, an `ancf_cable` or a body with `flexible`."
    ),
    "crank": "A crank is a `rigid_body` on a `revolute` joint, turned by a `drive`.",
    "play": (
        "Play of a pin is its `clearance`, with a law of `contact_laws`; of gear teeth the "
        "`backlash` of a `gear_mesh`; along a slide, two `limit_stop`s."
    ),
    "clearance": (
        "Play of a pin: a `revolute` joint with a `clearance` (m, of the radius) and a "
        "`contact`, the name of a law in `contact_laws`."
    ),
    "lock": (
        "Events and phases `lock` and `release` joints. A joint that never moves is a `fixed` one."
    ),
    "chain": (
        "A chain over sprockets is a `belt`; links of a chain are bodies on `revolute` joints."
    ),
    "pulley": "Pulleys are those of a `belt` or of a `rope`.",
    "teeth": (
        "Numbers of teeth are `teeth` of a `gear`; elastic teeth with `backlash` are a `gear_mesh`."
    ),
    "pinion": "A pinion on a rack is a `rack_and_pinion`; two gears are a `gear`.",
    "rack": "A rack and its pinion are a `rack_and_pinion`.",
    "wheel": (
        "A gear wheel is one of a `gear` or a `worm`; a wheel that rolls, a roller of a "
        "`surface_contact`."
    ),
    # --- forces
    "friction": (
        "In a pin with play, and between what touches, friction is `friction` of a law in "
        "`contact_laws`; in an ideal joint it is a `joint_friction`, which follows from the "
        "reaction of the joint. Its laws: none, coulomb, modified_coulomb, sticking."
    ),
    "contact": (
        "In a pin with play: `clearance`. Along a slide or about a hinge: `limit_stop`. Of "
        "balls, rollers, corners and outlines with surfaces: `surface_contact`. Of a line with "
        "a plane: `seal`. Their laws are in `contact_laws`."
    ),
    "impact": (
        "Touches follow a law of `contact_laws`; `normal: newton` and `normal: poisson` make "
        "them take no time. `restitution` says what is left of the speed."
    ),
    "stop": (
        "A stop of a joint is a `limit_stop`; one of a body against another, a `surface_contact`."
    ),
    "damper": (
        "A damper between two points is a `spring_damper`, by a function a `spring`; on a "
        "joint, a `torsion_spring` or a `joint_spring`."
    ),
    "motor": (
        "A motor is a `drive` of a joint, rigid, or with a `compliance`; one with a given "
        "torque, an `applied_load`."
    ),
    "cylinder": "A hydraulic cylinder, or a ram, is an `actuator`; the shape is one of `shape`.",
    "pressure": (
        "A pressure on an area is an `applied_load` of pressure times area, or, along a line, a "
        "`distributed_load`."
    ),
    "load": (
        "A load is an `applied_load`; six components of one, a `wrench`; along a line, a "
        "`distributed_load`. Loads act together as `load_sets`."
    ),
    # --- the file
    "units": (
        "A number without a unit is in SI. Behind a number stands one of these, or products and "
        "powers of them: 0.3 mm, 12 N*m/rad, 9.81 m/s^2. Angles are a dimension of their own: "
        "1/s is no rad/s."
    ),
    "functions": (
        "Loads, motions and laws may be expressions of t, of sensors and their rates "
        '("25*sin(2*pi*t)"), or tables: {table: [[0, 0], [0.1, 25]]}. They may use these '
        "functions, pi, comparisons, and `parameters`."
    ),
    "t": (
        "The time, s, in expressions; in the motion of a drive that begins with an event or a "
        "phase, the time since then."
    ),
    "pi": "3.14159..., in expressions.",
    "rate": (
        "NAME.rate is the rate of a sensor, in expressions and as a channel; under `initial`, "
        "JOINT.rate is how fast a joint moves at the start."
    ),
    "ground": "The body that never moves: `bodies: [ground, crank]`.",
    "world": (
        "The axes of the world, as a `frame` of loads and sensors; the drawing is in them "
        "unless the scenario has a `frame`."
    ),
    "first": (
        "Of two `bodies` the first carries: angles, strokes and places of a joint are those of "
        "the second against the first."
    ),
    "second": (
        "Of two `bodies` the second is carried: angles, strokes and places of a joint are its "
        "own against the first, and reactions are those that act on it."
    ),
    "all": "`equilibrium: all` under `initial` begins in balance with every joint free.",
    "true": "Yes, in YAML; false is no.",
    "recorded": (
        "The table of the result file with a line for each time an event with `record` happened."
    ),
    "name": (
        "Entries of a section have names, which all share one name space; a phase may have a "
        "`name`."
    ),
    "work": (
        "Of an event: what it changes of kinetic and stored energy, J, in the table of events. "
        "energy.work of a run is the book of all works."
    ),
    "chaos": (
        "`trsim run --certify` says until when a motion can be predicted; `poincare` and `trsim "
        "report --lyapunov` show what comes after."
    ),
}
SWEEP = (  # keys of `sweep` that are no path: word, what it may be, meaning
    ("method", "grid | zip | latin_hypercube | monte_carlo | sobol", "how the values are combined: "
     "grid, all combinations; zip, side by side; the others draw `samples` from distributions"),
    ("samples", "whole number", "how many are drawn; of sobol a power of two"),
    ("seed", "whole number", "of draws: the same one gives the same cases on every machine"),
    ("keep", "all | summary", "of every case: its result file, or its numbers only"),
    ("numbers", "list", "numbers of a run, as in `trsim show`, that are kept of every case too: "
     "peak:B.contact_force@0.3..0.5"),
    ("until", "mapping of numbers of a run to widths", "of monte_carlo and sobol: samples are run "
     "until half of the 95 % interval is no more than this: of the mean over cases, 2 % of it or "
     "20 N; of sobol's indices, 0.05"),
    ("refine", "mapping", "of a grid: which values are run first; those between are run where "
     "neighbours differ, in status or in a number"),
    ("refine.every", "whole number | mapping of keys to whole numbers", "8 runs each 8th value of "
     "an axis first; of a key that a mapping does not name all are run"),
    ("refine.by", "mapping of numbers of a run to widths", "neighbours differ too where a number "
     "does by more than this: {peak:B.contact_force: 5 %}"),
)  # fmt: skip
