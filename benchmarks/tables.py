"""Tables of the docs, as the commands print them."""


def head(*names: str) -> None:
    """The head of a table, and the line below it."""
    row(*names)
    print("|" + "---|" * len(names))


def row(*cells: object) -> None:
    """A line of a table; what is empty or None leaves its cell empty."""
    told = ("" if cell is None else str(cell) for cell in cells)
    print("|" + "|".join(f" {cell} " if cell else " " for cell in told) + "|", flush=True)


def power(x: float, digits: int = 1) -> str:
    """A number as 1.2e-4: without the zeros of its exponent."""
    if x == 0.0:
        return "0"
    mantissa, exponent = f"{x:.{digits}e}".split("e")
    return f"{mantissa}e{int(exponent)}"
