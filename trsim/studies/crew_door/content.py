"""What the page of the study says besides its figures and its statements, in our words."""

TITLE = "Crew entrance door: the published study, checked"

LEAD = (
    "A study of a crew entrance door that hinges at its bottom and serves as a staircase models it "
    "with a commercial package and compares with spreadsheets. Its coordinates, masses and loads "
    "are confidential, so its numbers cannot be repeated. Here a representative door of our own "
    "with the same parts goes through the same load cases, and each statement of the study that "
    "does not depend on its numbers is put to the test.",
    "Conclusions about this door are none about the real one.",
)

VERDICTS = (
    "Each statement is told in our words, with the number that decides it. The motion has no "
    "impacts that multiply differences: one run of each case decides.",
    "confirmed: the numbers lie on the side of the statement; contradicted: on the other side.",
    "By how much cases must differ, or may, is told with each number.",
    "undetermined: neither, or nothing that could be measured decides it.",
    "by construction: our data were made to agree, so that agreement proves nothing.",
    "by selection: of several data the ones that agree were taken, so that agreement proves "
    "little.",
)

ENDS = (
    "done: the case came to its end. limit: a static path came to a place behind which there is "
    "no equilibrium, where the roller leaves the guide and nothing but a hand holds the door. "
    "stalled: nothing moved any more. slack: the wire went slack. released: the hinges let go."
)

CRITICAL = (
    "The largest and the smallest of what parts are sized by, in which case, when, and at which "
    "angles. `trsim report SWEEP --envelope` makes it of any quantities."
)

ASSUMPTIONS = (
    "All coordinates, masses, stiffnesses and load tables are ours, but for the angles, times, "
    "gap and hand load that the study states; mechanism.yaml says of each number where it is from.",
    "Which rods join handles and gearbox was inferred from which rods the study shows loaded by "
    "which jam: outer handle, P2P6, inner handle, P7P10, gearbox.",
    "The guide's nose was placed so that the roller meets it at 28 deg of the latch, and its flank "
    "was sloped so that a gap of 1.3 mm makes 5 deg of that; its exit makes the handle load "
    "negative.",
    "Seals are line loads that are integrated over the part that is pressed; seven springs at "
    "even distances with their ends included, as a prototype of this data set had them, give 2 % "
    "more at the handle.",
    "Opening begins at 2.6 deg of the hinge, where lifting ends. At 0 deg the rod of the "
    "counterbalance passes so near the hinge line that the compressed seals alone press it with "
    "13 kN.",
    "In a jam the contacts of the door hold what the hand does to it, with the door unlocked.",
    "In jettison the arm and the rod of the counterbalance are parked once they have come off.",
)

CONTRADICTIONS = (
    "The study explains a difference above 70 deg of the latch by inertia, at less than 6 deg/s of "
    "the handle. Here static path and motion agree to 1 % of the largest force up to 94.5 deg; "
    "inertia shows only behind it, where the roller leaves the guide.",
    "It lets go of the handle at 58 deg, where its handle load is already negative by its own "
    "figure but not by its text, which has 70 deg.",
    "It takes friction of its seals from contacts first and finds them counted several times; "
    "springs of a seventh each keep the sum, and still depend on where they stand.",
    "A spherical and a cylindrical joint about one dummy part leave it an idle spin; a prismatic "
    "one in place of the cylindrical does not. Here a joint of two rows does without the part.",
)
