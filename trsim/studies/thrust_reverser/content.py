"""What the page of the study says besides its figures and its claims, in our words."""

TITLE = "Thrust reverser: the published study, checked"

LEAD = (
    "A study of a cascade thrust reverser simulates one chain of its mechanism with clearance"
    " in two pins, A and B, and with a rigid and a flexible rod, and draws conclusions from "
    "single runs. Here every configuration with impacts was run again as an ensemble: the start "
    "of the stroke, the clearance (by 2 %) and the tolerance of the solver are varied, since "
    "impacts multiply any difference. Figures show the member as stated; verdicts rest on all "
    "members.",
    "Conclusions about this data set are no conclusions about the real machine, nor about the"
    " data of the study, most of which it does not state.",
)

VERDICTS = (
    "Each claim is told in our words, with the number that decides it. Intervals are 95 % "
    "intervals of the mean of the ensemble, and of ratios of members that differ from the "
    "stated case alike.",
    "confirmed: the interval lies on the side of the claim; a bound is kept by every member, too.",
    "contradicted: the interval lies on the other side; a bound is kept by no member, too.",
    "A difference between cases of less than 1 % counts as none.",
    "undetermined: neither, or nothing that could be measured decides it.",
    "holds in: of how many members the claim is true, which is the chance of a single run to "
    "show it.",
    "by construction: our data were tuned to agree, so that agreement proves nothing; so are "
    "trends and orderings that share their data with such a fit.",
    "geometry, bookkeeping: lengths and clearances, or a formula, a count or a balance of the "
    "load, decide it whatever the motion is. They are counted apart from what was found.",
    "Cases with five doors and three actuators are smooth and have one run each: a difference is "
    "there or it is not.",
    "by selection: B was chosen among four pins as the one whose clearance has most effect, "
    "so that agreement proves little.",
)

PEAKS = (
    "The largest forces of the actuators over 418, 419, 421 and 422 mm/s of one of them. The "
    "stiffness of the actuators, their angles and radius, the stiffnesses of the rails in both "
    "directions and the asymmetry of the loads were fitted to these nine numbers, so that "
    "agreement proves little; nor do the orderings above, which share their data with this fit."
)

STICKING = (
    "Actuator 2 slower than the others, all three with a supply that gives way, over the "
    "stiffness of the synchronising shaft: where and when the supply of an actuator reaches 3 "
    "kN, a stall force of ours just above the largest force of the study. A stiffer shaft lowers "
    "the forces on the fairing, but its pull adds to what the supply of the slow actuator holds "
    "back, so that it stalls earlier."
)

ASSUMPTIONS = (
    "The study states lengths, masses, clearances, contact parameters, speeds, the size of "
    "the load and a time line, but no coordinates of joints, load curve, spring, seat, lug or"
    " actuator. These were completed; mechanism.yaml says of each number where it is from.",
    "Tuned to what the study states: the touch of the lug at 0.30 s, the largest driving "
    "force at 0.95 s, the turn of 90 deg, and the centre of pressure (800 N of driving "
    "force).",
    "A is the pin of the large rod on the fixed structure, B the hinge of the door on the "
    "fairing: the study only implies that B is near the fairing.",
    "The drive is kinematic, so that impacts reach it in full; positive driving forces hold "
    "back. Contact: Hertz with R_i \u2212 R_j, Lankarani and Nikravesh's damping, friction "
    "with a ramp.",
    "Fluctuation: root mean square of a curve less its double moving average of 10 ms, "
    "between 150 and 480 mm of stroke, from the touch of the lug to before the end. Windows "
    "are of stroke, so that both speeds and all members are compared alike.",
    "The mechanism with five doors and three actuators has ideal joints, no impacts that "
    "multiply differences, and no ensemble: a run of each case decides. Its force along X is "
    "positive where an actuator holds the fairing back; late in the stroke the gas drives the "
    "fairing aft. Fitted to the nine peaks of the study: stiffness, angles and radius of the "
    "actuators, stiffnesses of the rails, asymmetry of the loads. Ball ends of the actuators, "
    "supplies, shaft and stall force are ours.",
    "A stroke of a second is no periodic motion, and has no forcing period to take a section "
    "with. The section taken is where the eccentricity in x turns from falling to rising. "
    "Where the journal stays in contact its points follow the contact around the bearing as "
    "the load turns: their spread is then geometry, and no measure of chaos.",
)

CONTRADICTIONS = (
    "The moments of inertia of the study have the unit m^4 and are those of sections; as kg "
    "m^2 they would give a rod of 220 mm a radius of gyration of 0.6 mm. Taken: m L^2 / 12.",
    "Its contact stiffness has R_i + R_j, right for two spheres side by side; a journal in a "
    "bearing has R_i \u2212 R_j and is 6 to 14 times stiffer. Both were run.",
    "Its integration step of 1 ms with a Runge-Kutta method of fourth order is unstable with "
    "these contacts: it diverges in every case with clearance.",
    "Its flexible rod weighs 3.454 kg in steel, where its table of masses says 0.5 kg. Five "
    "rods were run: rigid and flexible of either mass, damped and not.",
    "Which joints have clearance at the two speeds differs between its text (B) and its "
    "figures (A and B). Both were run.",
    "It finds the motion at higher speed more periodic in its section on speed, and more "
    "nonlinear in its conclusions.",
    "Its friction law has no force below 0.1 mm/s, so that a loaded joint never rests but creeps.",
    "Its advice to run actuator 2 slower rests on a load that drives the fairing: against a load "
    "that resists, the actuator ahead carries more, and the advice turns round.",
    "Its beam is planar, the pendulum that is to verify it is not; section, gravity and mesh "
    "of that pendulum are not stated.",
)
