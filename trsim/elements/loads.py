"""What all loads share: they may stand in a load set, whose factor multiplies them."""

from typing import Any, Self

from trsim.fields import Spec
from trsim.varying import FunctionSpec


class Load(Spec):
    """An entry of `forces` that is a load: its magnitudes are functions among its keys."""

    def scaled(self, factor: float) -> Self:
        """The load with all its magnitudes times a factor."""
        return self.model_copy(update={key: _scaled(of, factor) for key, of in self})


def _scaled(value: Any, factor: float) -> Any:
    if isinstance(value, FunctionSpec):
        return value.scaled(factor)
    if isinstance(value, tuple):
        return tuple(_scaled(item, factor) for item in value)
    return value
