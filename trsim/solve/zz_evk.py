from trsim.assemble.equations import evaluate
from trsim.elements import signatures as types
from trsim.elements.contract import SCENE, compiled
from trsim.elements.packed import A1, i8


@compiled(types.void(SCENE, A1, A1, i8))
def many(s, y, yd, n):
    for k in range(n):
        evaluate(s, 0.0, y, yd)
