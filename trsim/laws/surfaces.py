"""Surfaces: how far a point is from one, on which side, and which way it points away from it.

    plane      s = y
    sphere     s = |p| - R
    cylinder   s = |(x, y)| - R                        its axis is z
    profile    s = the distance of (x, y) from a line of straight pieces and arcs, drawn out along z

p = (x, y, z) is in the axes of the surface, s > 0 on its free side; the unit normal n = grad s
points there.  A hollow sphere, cylinder or closed profile is free inside: s and n change their
signs.  An open profile is a thin plate, free on both sides; and so is a part of a closed one.

s is 1-Lipschitz, and as long as one place alone is nearest its second derivatives lie between

    -1 / (reach - s)  and  1 / (sharp + s)

with `sharp` the least radius by which the surface is round towards the free side, 0 at an edge, and
`reach` the radius of the largest ball that touches no second place anywhere.

A profile in a flat array is, from its offset,

    how many pieces it has, the depth of their tree, and where the pieces begin
    sure          the radius of a ball that touches no second place on the free side, negative if
                  that is on the right; 0 where none is known

NODE numbers of each node of the tree, and SIZE numbers of each piece.  Node 1 is the root, 2 k and
2 k + 1 are the children of node k, and the leaves begin at 2^depth.  The pieces are shared out
among the leaves in their order.  Of a node

    u, v          unit vector; a place of it is u x + v y along, u y - v x across
    split         along: where its first child ends and the second one begins
    from, to      along, of all its places
    from, to      across

of a piece

    STRAIGHT    x, y of its start, unit vector along it, length         the free side is on its left
    ROUND       x, y of its centre, R, unit vector to its middle, cosine of half its angle
    HOLLOW      the same, seen from its centre
    EDGE        x, y of a place where two pieces meet at an angle, or where an open profile ends
"""

from math import inf, sqrt

from trsim.kernels.lazy import internal

PLANE, SPHERE, CYLINDER, PROFILE = range(4)
SHAPES = {"plane": PLANE, "sphere": SPHERE, "cylinder": CYLINDER, "profile": PROFILE}
STRAIGHT, ROUND, HOLLOW, EDGE = range(4)
SIZE, NODE, HEAD = 7, 7, 4
ROUNDING = 1e-12  # of the length of a piece: what lies so little beyond its end lies on it
SURELY = 1.0 + 1e-12  # of the squares of two distances: the larger one is larger indeed


@internal
def away(tab, own, p):
    """s and n of a point p, in the axes of the surface.

    Parameters
    ----------
    tab : (...) float    numbers of profiles
    own                  any record with the numbers
                         shape    one of SHAPES
                         radius   R of a sphere or a cylinder, m
                         free     1, or -1 of what is free inside
                         profile  offset in tab
                         closed   1 of a closed profile, 2 of a part of one
    p : (3) float        m

    Returns
    -------
    (float, (3) float)   s, m, and n; where no direction is nearest n is x
    """
    if own.shape == PLANE:
        return p[1], (0.0, 1.0, 0.0)
    if own.shape == PROFILE:
        s, n = beside(tab, own.profile, own.closed, p[0], p[1])
        return own.free * s, (own.free * n[0], own.free * n[1], 0.0)
    z = p[2] if own.shape == SPHERE else 0.0
    far = sqrt(p[0] * p[0] + p[1] * p[1] + z * z)
    if far == 0.0:
        return -own.free * own.radius, (own.free, 0.0, 0.0)
    by = own.free / far
    return own.free * (far - own.radius), (by * p[0], by * p[1], by * z)


@internal
def beside(tab, o, closed, x, y):
    """s and n of a point of the plane of a profile, n two numbers."""
    place = nearest_piece(tab, o, x, y)
    if place < 0:
        return inf, (1.0, 0.0)
    s, along, across = off_piece(tab, place, closed, x, y)
    return s, (along, across)


@internal
def nearest_piece(tab, o, x, y):
    """Where the piece is that is nearest to a point, the first of several; -1 of none."""
    nodes, leaves = o + HEAD - NODE, 1 << int(tab[o + 1])
    node = guess(tab, nodes, leaves, x, y)
    near, found = in_leaf(tab, o, node - leaves, x, y, (inf, -1))
    if found < 0:  # the point is beside the ends of all of them, but not further away than that
        near = to_farthest(tab, nodes + NODE * node, x, y)
    elif is_foot(tab, o, found, x, y):
        return found
    near, found = elsewhere(tab, o, node, x, y, (near, found))
    if found < 0:
        near, found = elsewhere(tab, o, node, x, y, (inf, -1))
    return found


@internal
def is_foot(tab, o, place, x, y):
    """Whether the ball around a point that touches a piece surely touches nothing else."""
    if tab[place] == EDGE or tab[o + 3] == 0.0:
        return False
    s, _, _ = off_piece(tab, place, 1, x, y)
    return 0.0 < s < tab[o + 3] or tab[o + 3] < s < 0.0


@internal
def elsewhere(tab, o, node, x, y, known):
    """How far a point is from the nearest piece, and where that is, if it is nearer than what is
    known of a leaf.

    From the leaf up to the root the other child of each node is looked through.  Nodes that are
    further away than what is known are left out.
    """
    near, found = known
    nodes, leaves = o + HEAD - NODE, 1 << int(tab[o + 1])
    while node > 1:
        top = node ^ 1
        node >>= 1
        k = top
        while k > 0:
            if off_node(tab, nodes + NODE * k, x, y) > near * near * SURELY:
                k = following(k, top)
            elif k < leaves:
                k *= 2
            else:
                near, found = in_leaf(tab, o, k - leaves, x, y, (near, found))
                k = following(k, top)
    return near, found


@internal
def guess(tab, nodes, leaves, x, y):
    """A leaf that is rather near."""
    node = 1
    while node < leaves:
        # a loop, not a sum: from one evaluation to the next the way down is mostly the same, and
        # processors that foresee branches need not wait for each comparison
        while beyond(tab, nodes + NODE * node, x, y):
            node = 2 * node + 1
            if node >= leaves:
                return node
        node *= 2
    return node


@internal
def beyond(tab, k, x, y):
    """Whether a point is on the side of the second child of a node."""
    return tab[k] * x + tab[k + 1] * y > tab[k + 2]


@internal
def following(node, top):
    """The node behind another one and all below that, of those below `top`; 0 of none."""
    while node != top and node & 1 == 1:
        node >>= 1
    return 0 if node == top else node + 1


@internal
def leaf(tab, o, k):
    """Where the pieces of a leaf begin, and where those of the next one do."""
    many, depth, first = int(tab[o]), int(tab[o + 1]), o + int(tab[o + 2])
    return first + SIZE * (k * many >> depth), first + SIZE * ((k + 1) * many >> depth)


@internal
def in_leaf(tab, o, k, x, y, known):
    """How far a point is from the nearest piece of a leaf, and where that is, if it is nearer than
    what is known."""
    near, found = known
    place, end = leaf(tab, o, k)
    while place < end:
        far = to_piece(tab, place, x, y)
        if far < inf and (far < near or (far == near and place < found)):
            near, found = far, place
        place += SIZE
    return near, found


@internal
def off_node(tab, k, x, y):
    """The square of how far a point is from the box of a node."""
    along = tab[k] * x + tab[k + 1] * y
    across = tab[k] * y - tab[k + 1] * x
    a = max(tab[k + 3] - along, along - tab[k + 4], 0.0)
    b = max(tab[k + 5] - across, across - tab[k + 6], 0.0)
    return a * a + b * b


@internal
def to_farthest(tab, k, x, y):
    """How far a point is from the farthest corner of the box of a node."""
    along = tab[k] * x + tab[k + 1] * y
    across = tab[k] * y - tab[k + 1] * x
    a = max(along - tab[k + 3], tab[k + 4] - along)
    b = max(across - tab[k + 5], tab[k + 6] - across)
    return sqrt(a * a + b * b)


@internal
def to_piece(tab, place, x, y):
    """How far a point is from a piece, inf where it is beside its ends."""
    kind, a, b = tab[place], x - tab[place + 1], y - tab[place + 2]
    u, v = tab[place + 4], tab[place + 5]
    if kind == STRAIGHT:
        t, m, length = tab[place + 3], u, v
        along = t * a + m * b
        if not -ROUNDING * length <= along <= (1.0 + ROUNDING) * length:
            return inf
        return abs(t * b - m * a)
    square = a * a + b * b
    if square == 0.0:
        return inf  # in no direction
    if kind == EDGE:
        return sqrt(square)
    ahead, least = a * u + b * v, tab[place + 6] - ROUNDING
    if ahead * abs(ahead) < (least - ROUNDING) * abs(least - ROUNDING) * square:
        return inf  # as below, of most pieces without a root
    far = sqrt(square)
    if ahead < least * far:
        return inf
    return abs(far - tab[place + 3])


@internal
def off_piece(tab, place, closed, x, y):
    """s and the two of n of a point that is not beside the ends of a piece."""
    kind, a, b = tab[place], x - tab[place + 1], y - tab[place + 2]
    if kind == STRAIGHT:
        t, m = tab[place + 3], tab[place + 4]
        aside = t * b - m * a
        sign = 1.0 if closed == 1 or aside >= 0.0 else -1.0
        return sign * aside, -sign * m, sign * t
    far = sqrt(a * a + b * b)
    if kind == EDGE:
        return far, a / far, b / far
    out, off = 1.0 if kind == ROUND else -1.0, far - tab[place + 3]
    if closed != 1 and out * off < 0.0:
        out = -out
    return out * off, out * a / far, out * b / far
