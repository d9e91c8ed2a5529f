"""What is measured in the docs: the command that prints it, and the sources it depends on."""

from typing import Literal, NamedTuple

# tables: what the command prints takes the place of what is there.  page: the command writes it.
# copied: its numbers stand beside words and older numbers, where somebody has to put them
Way = Literal["tables", "page", "copied"]


class Made(NamedTuple):
    """An entry; without `asked`, `make docs` makes it wherever it is stale."""

    command: str
    of: tuple[str, ...]
    way: Way = "copied"
    asked: str = ""  # why it is only made by its name
    words: bool = False  # whether sentences in sources are a part of what is made


SOLVER = ("trsim/laws", "trsim/elements", "trsim/assemble", "trsim/solve")
REVERSER = ("scenarios/thrust_reverser",)
DOOR = ("scenarios/crew_door",)
BENCH = ("benchmarks/measure.py", "benchmarks/work_precision.py")
TIMES = "it measures times and needs a quiet machine"
LONG = "it takes minutes to an hour"
HAND = "its numbers are copied by hand"


def bench(name: str, *of: str, way: Way = "copied", asked: str = TIMES) -> Made:
    """A module of benchmarks."""
    file = f"benchmarks/{name}.py"
    return Made(f"python -m benchmarks {name}", (*SOLVER, *BENCH, file, *of), way, asked)


def scenes(name: str, *tests: str, asked: str = "") -> Made:
    """A module of benchmarks that measures scenes of tests."""
    return bench(name, *(f"tests/{test}.py" for test in tests), way="tables", asked=asked)


MADE: dict[str, Made] = {
    "reference": Made(
        "python -m benchmarks.docs.reference",
        ("trsim/elements", "trsim/scenario", "trsim/units.py", "benchmarks/docs/reference.py"),
        "page",
        words=True,
    ),
    "gallery": Made(
        "python -m benchmarks.gallery",
        ("benchmarks/gallery", "trsim/report/animation", "trsim/scenario/shipped.py",
         "scenarios/gallery"),
        "page",
        "it draws twenty pictures",
        words=True,
    ),
    "truth": Made("make truth", (*SOLVER, "tests/truth"), "page", LONG),
    "stress": Made("make stress", (*SOLVER, "benchmarks/stress"), "page", LONG),
    "turns": bench("turns", way="tables", asked=""),
    "reverser_ideal": bench("reverser_ideal", *REVERSER, way="tables", asked=""),
    "reverser_table": bench("reverser_table", *REVERSER, way="tables", asked=""),
    "reverser_steps": bench("reverser_steps", *REVERSER, way="tables", asked=""),
    "skipping": bench("skipping", *REVERSER, way="tables"),
    "slider_crank": bench("slider_crank", "benchmarks/minimal.py", way="tables"),
    "reverser": bench("reverser", *REVERSER, way="tables"),
    "rods": bench("rods", *REVERSER, way="tables"),
    "spatial": bench("spatial", *REVERSER, way="tables"),
    "fit_spatial": Made(
        "python -m benchmarks.fit_spatial",
        (*SOLVER, "benchmarks/fit_spatial.py", *REVERSER),
        asked=HAND,
    ),
    "peers": Made(
        "python -m benchmarks andrews pendulum windows chain slider_crank",
        (*SOLVER, *BENCH, "benchmarks/problems.py", "benchmarks/peers", "benchmarks/windows.py",
         "benchmarks/chain.py", "benchmarks/andrews.py", "benchmarks/pendulum.py"),
        asked=TIMES,
    ),
    "against": Made(
        "python -m benchmarks.against FOLDER", (*SOLVER, "benchmarks/against.py"), asked=TIMES
    ),
    "beside": bench(
        "beside", "benchmarks/trees", "benchmarks/thousands.py", "benchmarks/slider_crank.py",
        "benchmarks/minimal.py", "benchmarks/problems.py", "trsim/sweeps", *REVERSER, way="tables",
    ),
    "chain": bench("chain", way="tables"),
    "chains": bench("chains", way="tables"),
    "contacts": bench("contacts", way="tables"),
    "windows": bench("windows", way="tables"),
    "flexible_pendulum": bench("flexible_pendulum", way="tables"),
    "sweeps": bench("sweeps", "trsim/sweeps", way="tables"),
    "thousands": bench("thousands", "benchmarks/trees", "trsim/sweeps", way="tables"),
    "dask": bench("dask", "trsim/sweeps", way="tables"),
    "startup": bench("startup", "trsim/kernels", "trsim/cli", way="tables"),
    "certify": bench("certify", "trsim/analyse", *REVERSER, way="tables"),
    "user_events": scenes("user_events", "solve/test_user_events"),
    "sections": bench("sections", "trsim/analyse/section.py", *REVERSER, way="tables", asked=""),
    "norm": scenes("norm", "solve/test_norm"),
    "works": scenes("works", "solve/test_works"),
    "kinematic": scenes("kinematic", "solve/test_kinematic_counts"),
    "symmetry": bench("symmetry", "tests/linkages.py", *REVERSER, way="tables", asked=""),
    "beams": scenes("beams", "solve/test_beams_at_rest", "solve/test_beams_moving"),
    "lyapunov": Made(
        "python -m benchmarks lyapunov",
        ("benchmarks/lyapunov.py", "tests/analyse/series.py", "trsim/analyse/lyapunov.py",
         "trsim/analyse/embedding.py", "trsim/analyse/scaling.py", "trsim/analyse/growth.py"),
        "tables",
    ),
    "verdicts": bench("verdicts", *REVERSER, "trsim/studies", way="tables", asked=LONG),
    "paper": Made("make paper", (*SOLVER, *REVERSER, "trsim/studies/thrust_reverser"), asked=LONG),
    "jam": bench("jam", *REVERSER, way="tables", asked=""),
    "tolerances": bench("tolerances", *REVERSER, way="tables", asked="it takes ten minutes"),
    "door": Made("make door", (*SOLVER, *DOOR, "trsim/studies/crew_door"), asked=LONG),
    "release": Made(
        "make release-check", ("trsim/store", "trsim/sweeps", "trsim/cli", "tests/store",
                               "tests/sweeps", "tests/cli"), asked=LONG),
    "portable": Made("make portable", (*SOLVER, "tests/portable"), asked=LONG),
    "tutorial": Made(
        "python -m benchmarks.gallery first_mechanism",
        ("docs/first_mechanism.md", "benchmarks/gallery", "trsim/report"),
        "page",
        "it draws pictures",
        words=True,
    ),
}  # fmt: skip

# heads of tables that are not measured: words, keys, options, units
LISTS: dict[str, tuple[str, ...]] = {
    "theory.md": ("| law | chi |",),
    "why_did_my_run_fail.md": (
        "| code | what it means | what to do |",
        "| it says | why | what to do |",
        "| it says | what to do |",
    ),
    "README.md": (
        "| read | for |",
        "| YAML | kernel | |",
    ),
    "architecture.md": (
        "| record | what it holds |",
        # of a design that is gone, and cannot be measured again
        "| how the arrays reach the code | us per evaluation | compiling |",
    ),
    "commands.md": (
        "| command | what |",
        "| option | what it gives |",
        "| ending | what |",
        "| code | meaning |",
    ),
    "crew_door.md": ("| file | what |",),
    "extending.md": ("| what | files new | files changed | lines |",),
    "install.md": ("| system | what was run |",),
    "numerics.md": ("| method | order | error estimate | dense output |",),
    "python.md": ("| class | exit code of the command | |",),
    "scenarios.md": (
        "| section | what |",
        "| key | what |",
        "| type | keys | coordinate |",
        "| type | keys | relation |",
        "| type | keys |",
    ),
    "studies.md": ("| word | number |",),
}
