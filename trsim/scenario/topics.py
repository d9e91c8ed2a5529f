"""Words that an engineer asks for and that are no key: what there is for them, and where.

A word in backticks is one that `trsim explain` knows.
"""

TOPICS = {
    # --- what bodies and bars do
    "torsion": (
        "A torsional spring on a joint is a `torsion_spring`; between two bodies, a `bushing` with"
        " `rotational_stiffness`. The torsion in a rigid body at a station is the z component of "
        "the moment of a `section`. Bars that bend (`ancf_cable`) have no torsion; anything that "
        "would twist one is refused."
    ),
    "shear": (
        "The shear force in a rigid body at a station is `shear` of a `section`; that of a pin is "
        "its `reaction`. Bars that bend (`ancf_cable`) have no shear deformation; use them for "
        "bars longer than about eight times their thickness."
    ),
    "bending": (
        "For a bar that bends, use an `ancf_cable` or a rigid body with `flexible`. The bending "
        "moment in a rigid body at a station is `bending` of a `section`."
    ),
    "buckling": (
        "Bars that bend (`ancf_cable`) buckle. `method: static_path` of `solver` follows a load up"
        " to the point where a column buckles, and reports it. `equilibrium` of `initial` refuses "
        "a bar beyond its buckling load that could bend to either side; a small lateral load "
        "decides which side."
    ),
    "stress": (
        "Stresses inside a body are not computed. A `section` gives the force and the moment from "
        "which to compute them, with their `shear` and `bending` parts."
    ),
    "weight": (
        "`gravity` gives all bodies their weight. Their total mass and its centre can be given by "
        "`totals`; `trsim check` prints them."
    ),
    "vibration": (
        "`trsim check --modes` prints the frequencies, damping and shapes of small motions at the "
        "start; `trsim report --spectrum` draws the spectrum of a channel."
    ),
    "resonance": "`trsim check --modes` prints the frequencies of small motions at the start.",
    "equilibrium": (
        "`trsim statics` finds the position in which a mechanism rests. `equilibrium` of `initial`"
        " starts a run there. `method: static_path` of `solver` follows the equilibrium along a "
        "motion."
    ),
    # --- joints
    "hinge": (
        "A hinge is a `revolute` joint; with two bearings, a `shaft`; with play, a `revolute` "
        "joint with a `clearance`."
    ),
    "pin": "A pin is a `revolute` joint; for play, give it a `clearance`.",
    "bearing": (
        "A bearing is a `revolute` joint. Two bearings on a shaft are a `shaft`; for play, give "
        "the joint a `clearance`; an elastic bearing is a `bushing`."
    ),
    "ball": (
        "A ball joint is a `spherical` joint. A ball that rolls on a surface or hits it is part of"
        " a `surface_contact`."
    ),
    "slider": "A slide is a `prismatic` joint; if it may also turn, a `cylindrical` joint.",
    "slide": "A slide is a `prismatic` joint; if it may also turn, a `cylindrical` joint.",
    "rod": (
        "A massless rod between two ball joints is a `link`; a rod with mass is a `rigid_body`; a "
        "rod that bends is an `ancf_cable` or a body with `flexible`."
    ),
    "crank": "A crank is a `rigid_body` on a `revolute` joint, turned by a `drive`.",
    "play": (
        "Play in a pin is its `clearance`, with a law of `contact_laws`; play between gear teeth "
        "is the `backlash` of a `gear_mesh`; for play along a slide, use two `limit_stop`s."
    ),
    "clearance": (
        "Play in a pin: a `revolute` joint with a `clearance` (m, difference of the radii) and a "
        "`contact`, the name of a law in `contact_laws`."
    ),
    "lock": (
        "Events and phases can `lock` and `release` joints. A joint that never moves is a `fixed` "
        "joint."
    ),
    "chain": (
        "A chain over sprockets is a `belt`; for the links of a chain, use bodies with `revolute` "
        "joints."
    ),
    "pulley": "Pulleys are part of a `belt` or of a `rope`.",
    "teeth": (
        "The numbers of teeth are `teeth` of a `gear`; for elastic teeth with `backlash`, use a "
        "`gear_mesh`."
    ),
    "pinion": "A pinion on a rack is a `rack_and_pinion`; two gears are a `gear`.",
    "rack": "A rack and its pinion are a `rack_and_pinion`.",
    "wheel": (
        "A gear wheel is part of a `gear` or a `worm`; a wheel that rolls is the roller of a "
        "`surface_contact`."
    ),
    # --- forces
    "friction": (
        "In a pin with play, and in any contact, friction is `friction` of a law in "
        "`contact_laws`. In an ideal joint it is a `joint_friction`, which depends on the reaction"
        " of the joint. Its laws: none, coulomb, modified_coulomb, sticking."
    ),
    "contact": (
        "In a pin with play: `clearance`. Along a slide or about a hinge: `limit_stop`. Between a "
        "ball, roller, corner or outline and a surface: `surface_contact`. Between a line and a "
        "plane: `seal`. Laws of contact are in `contact_laws`."
    ),
    "impact": (
        "Impacts follow a law of `contact_laws`; with `normal: newton` or `normal: poisson` they "
        "take no time. `restitution` is the fraction of the speed that remains."
    ),
    "stop": (
        "A stop in a joint is a `limit_stop`; a stop between two bodies, a `surface_contact`."
    ),
    "damper": (
        "A damper between two points is a `spring_damper`, or a `spring` if its law is a function;"
        " a damper on a joint is a `torsion_spring` or a `joint_spring`."
    ),
    "motor": (
        "A motor is a `drive` of a joint, rigid or with a `compliance`; a motor with a given "
        "torque is an `applied_load`."
    ),
    "cylinder": "A hydraulic cylinder, or a ram, is an `actuator`; the solid is one of the forms "
    "of `shape`.",
    "pressure": (
        "A pressure on an area is an `applied_load` of pressure times area, or, along a line, a "
        "`distributed_load`."
    ),
    "load": (
        "A force or torque is an `applied_load`; a load with six components, a `wrench`; a load "
        "along a bar, a `distributed_load`. `load_sets` are loads that act together."
    ),
    # --- the file
    "drawn": (
        "As drawn means: in the configuration that the file describes, before anything moves."
    ),
    "units": (
        "A number without a unit is in SI. After a number you may write one of these units, or "
        "products and powers of them: 0.3 mm, 12 N*m/rad, 9.81 m/s^2. Angle is a dimension of its "
        "own: 1/s is not rad/s."
    ),
    "functions": (
        "Loads, motions and laws may be expressions of t, of sensors and their rates "
        '("25*sin(2*pi*t)"), or tables: {table: [[0, 0], [0.1, 25]]}. They may use these '
        "functions, pi, comparisons, and `parameters`."
    ),
    "t": (
        "The time, in s, in expressions. If an event or a phase gives a drive a new motion, t in "
        "that motion is the time since then."
    ),
    "pi": "3.14159..., in expressions.",
    "rate": (
        "NAME.rate is the rate of a sensor, in expressions and as a channel; under `initial`, "
        "JOINT.rate is the rate of a joint coordinate at the start."
    ),
    "ground": "The body that never moves: `bodies: [ground, crank]`.",
    "world": (
        "The fixed axes, as a `frame` of loads and sensors. The drawing is in these axes unless "
        "the scenario has a `frame`."
    ),
    "first": (
        "The first of two `bodies` carries the second: angles, strokes and positions of a joint "
        "are those of the second body relative to the first."
    ),
    "second": (
        "The second of two `bodies` is carried by the first: angles, strokes and positions of a "
        "joint are those of the second body relative to the first, and reactions are those that "
        "act on the second."
    ),
    "all": "`equilibrium: all` under `initial` starts in balance, with every joint free to move.",
    "true": "Yes, in YAML; false is no.",
    "recorded": (
        "The table of the result file with one row for each time that an event with `record` "
        "happened."
    ),
    "name": (
        "Every entry of a section has a name; no two may be the same, even in different sections. "
        "A phase may have a `name`."
    ),
    "work": (
        "The work of an event is the change of kinetic and stored energy, J, in the table of "
        "events. The channels energy.work of a run list all work, for the energy balance."
    ),
    "chaos": (
        "`trsim run --certify` says how long a motion can be predicted; `poincare` and `trsim "
        "report --lyapunov` show what comes after."
    ),
}
# numbers of a run: what comes before the colon (trsim/analyse/outputs.py)
NUMBERS = {
    "peak": (
        "CHANNEL",
        "the largest value in the motion, also between rows, with its sign; that of"
        " a vector is that of its magnitude, and peak:|CHANNEL| is the largest size",
    ),
    "least": ("CHANNEL", "the smallest value in the motion, also between rows"),
    "range": ("CHANNEL", "largest less smallest value"),
    "mean": ("CHANNEL", "the mean of the rows"),
    "rms": ("CHANNEL", "the root of the mean square of the rows"),
    "std": ("CHANNEL", "the standard deviation of the rows"),
    "fluctuation": ("CHANNEL", "the rms of what is faster than 10 ms"),
    "final": ("CHANNEL", "the value in the last row"),
    "dispersion": (
        "SECTION",
        "how far the points of a Poincare section are spread: the root of the"
        " sum of the variances of x and y",
    ),
    "points": ("SECTION", "the number of points of a Poincare section"),
    "flight": ("JOINT", "the share of the time in which a pin with play touches nothing"),
    "contact": ("JOINT", "the share of the time in which a pin with play is in contact"),
    "following": (
        "JOINT",
        "the share of the time in which a pin with play stays in contact and is pressed on again "
        "and again",
    ),
    "impacts": (
        "JOINT",
        "the number of touches that rebound after one blow: the depth rises and falls once",
    ),
    "onsets": ("JOINT", "the number of touches"),
    "between": ("JOINT", "the mean time from one touch to the next, s"),
    "summary": ("KEY", "a number of the summary of the run: summary:contacts.B.peak_force"),
    "solver": ("KEY", "a number that the solver tells: solver:steps"),
}
SWEEP = (  # keys of `sweep` that are no path: word, what it may be, meaning
    ("method", "grid | zip | latin_hypercube | monte_carlo | sobol", "how the values are combined: "
     "grid, all combinations; zip, side by side; the others draw `samples` from distributions"),
    ("samples", "whole number", "number of samples; for sobol a power of two"),
    ("seed", "whole number", "seed of the random numbers; the same seed gives the same cases on "
     "every machine"),
    ("keep", "all | summary", "what is kept of every case: its result file, or only its numbers; "
     "without it all of up to 200 cases, and summaries of more"),
    ("numbers", "list", "further numbers of a run to keep for every case, as in `trsim show`: "
     "peak:B.contact_force@0.3..0.5"),
    ("until", "mapping of numbers of a run to widths", "for monte_carlo and sobol: samples are run "
     "until half of the 95 % interval is no more than this; for the mean over the cases, for "
     "example 2 % or 20 N; for the indices of sobol, for example 0.05"),
    ("refine", "mapping", "for a grid: which values are run first; those between two neighbours "
     "are run only if these differ, in status or in a number"),
    ("refine.every", "whole number | mapping of keys to whole numbers", "8 runs every 8th value of "
     "an axis first; all values are run for a key that is not in the mapping"),
    ("refine.by", "mapping of numbers of a run to widths", "neighbours also differ if a number "
     "differs by more than this: {peak:B.contact_force: 5 %}"),
)  # fmt: skip
