"""The arrays of a model: what its elements say, and the rows it is solved with."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.addresses import Addresses
from trsim.assemble.band import band_tables
from trsim.assemble.beside import beside, near, near_rows
from trsim.assemble.equations import derivative, poses, without_feedback
from trsim.assemble.features import features
from trsim.assemble.instances import Instance, RowName
from trsim.assemble.jumps import steep
from trsim.assemble.layout import no_outputs
from trsim.assemble.least_norm import least_norm
from trsim.assemble.light import lightened, unfit
from trsim.assemble.loops import looped
from trsim.assemble.on_beams import addresses
from trsim.assemble.outputs import measured
from trsim.assemble.pattern import Hubs, lines, no_pattern, pattern
from trsim.assemble.poles import poles
from trsim.assemble.projection import on_rows, poses_and_rows, project_positions
from trsim.assemble.rubbing import rubbing, rubs_with
from trsim.assemble.rubbing import table as rubbing_table
from trsim.assemble.sizes import Sizes
from trsim.assemble.tables import (
    Masses,
    contact_numbers,
    drawn,
    eccentricity,
    judged,
    kernels,
    lone,
    masses,
    norm,
    struck,
    tables,
    turns,
    unequal,
    watched,
    watched_rows,
)
from trsim.assemble.travel import travels
from trsim.assemble.waves import pulsed, swinging
from trsim.elements.contract import N_BOOK, PHASE, UNLOCATED
from trsim.elements.scene import BAUMGARTE, N_MEM, NONE, PROJECTION, Model, Scene, scene

NONE_OF_THEM = np.zeros(0, np.int64)


class Parts(NamedTuple):
    """Instances with their addresses, and what models of them have in common, whatever their rows
    and in the plane or in space."""

    at: Addresses
    instances: list[Instance]
    sizes: Sizes
    shared: dict[str, Any]  # fields of Model

    @classmethod
    def of(cls, at: Addresses, instances: list[Instance]) -> Parts:
        solver, sizes = at.scenario.solver, Sizes.of(at)
        size = sizes.whole
        contacts = [e for e, i in enumerate(instances) if i.row.contact is not None]
        of_contacts = [i.row.contact for i in instances if i.row.contact is not None]
        touching = [instances[e] for e in contacts]
        rubs = rubbing_table(instances)
        stabilisation = {"none": NONE, "baumgarte": BAUMGARTE, "projection": PROJECTION}
        baumgarte = solver.baumgarte
        shared = {
            "n": len(at.frames),
            "n_r": at.n_rigid,
            "n_z": N_BOOK + len(at.states),
            "axes": at.rotation.reshape(len(at.frames), 9).copy(),
            "depth": at.at_start[:, 2].copy(),
            "tab": np.array(at.tab),
            "n_s": at.n_s,
            "n_mem": N_MEM + max((i.element.n_mem for i in instances), default=0),
            "rated": np.array([(k, s) for s, k in at.rates.items()], np.int64).reshape(-1, 2),
            **kernels(instances),
            "derivative": derivative.address(),
            "poses": poses.address(),
            "poses_and_rows": poses_and_rows.address(),
            "newton_step": project_positions.address(),
            "on_rows": on_rows.address(),
            "measured": measured.address(),
            "beside": beside.address(),
            "plain": without_feedback.address() if solver.stabilisation == "baumgarte" else 0,
            "judged": judged(instances),
            "tolerance": solver.tolerance,
            "on_beams": np.array(addresses(at.beams), np.int64),
            "stabilisation": stabilisation[solver.stabilisation],
            "alpha": baumgarte.alpha if baumgarte else 0.0,
            "beta": baumgarte.beta if baumgarte else 0.0,
            "contact": np.array(contacts, np.int64),
            "contact_state": np.array([c.state for c in of_contacts], np.int64),
            "contact_states": np.array([c.states for c in of_contacts], np.int64),
            "contact_impact": struck(at, touching),
            "contact_angle": np.array([eccentricity(i.element) for i in touching], np.int64),
            "contact_width": np.array(
                [sum(c.size for c in i.channels) for i in touching], np.int64
            ),
            **no_outputs(max(len(instances), 1)),
            **watched(at.switches, size),
            **features(at, instances),
            "steep": steep(at, instances),
            **poles(at, instances),
            "rubbing": np.array(rubs, np.int64).reshape(-1, 6),
            "rubbed_at": rubbing.address() if rubs else 0,
            "rubs_with": rubs_with.address() if rubs else 0,
            **travels(instances, contacts, at.switches),
            **pulsed(swinging(at, instances, at.waves)),
            "size": size,
        }
        return cls(at, instances, sizes, shared)


def build(
    parts: Parts,
    rows: list[RowName],
    d: int,
    hubs: Hubs | None = None,
    redundant: Sequence[RowName] = (),
    like: Model | None = None,
) -> Model:
    """The arrays of a model with the given constraint rows, without outputs.

    hubs: those of its solve; without them its rows can be looked at, and its equations not solved.
    redundant: rows that are looked at only.  like: another model of the same parts, made before.
    """
    at, instances, sizes, shared = parts
    n, size, contacts = len(at.frames), shared["size"], shared["contact"].tolist()
    con, par = tables(instances, [*rows, *redundant])
    of = masses(at, d, sizes)
    d_node = 4 if d == 3 else 6
    n_nodes = n - at.n_rigid
    q_node, v_node = (3 if d == 3 else 7) * (at.n_rigid - 1), d * (at.n_rigid - 1)
    frames = [r.frames for r in rows]
    arms = sizes.levers(lone(at, sizes, of))
    scale_kind, scale = norm(at, d, size, arms)
    if len(of.light):
        unfit([at.owners[f] for f in of.light], of.light, [i.row for i in instances],
              len(shared["rubbing"]) > 0)  # fmt: skip
    return Model(
        like,
        **(shared if like is None else {}),
        d=d,
        d_node=d_node,
        n_q=q_node + d_node * n_nodes,
        n_v=v_node + d_node * n_nodes,
        q_node=q_node,
        v_node=v_node,
        m=len(rows),
        unequal=int(hubs is not None and unequal(at, of, sizes.arms, d)),
        mass=of.mass,
        inertia=of.inertia,
        mass_inverse=of.mass_inverse,
        inertia_inverse=of.inertia_inverse,
        light=of.light,
        lacking=of.lacking,
        lightened=lightened.address() if len(of.light) else 0,
        con=con,
        par=par,
        **turns(at, d),
        **lines([*frames, *(r.frames for r in redundant)]),
        **(looked_at(len(frames), n) if hubs is None else solved(at, instances, rows, hubs, of)),
        **watched_rows(instances, rows, redundant, size),
        shared_out=least_norm.address() if redundant else 0,
        **band_tables(list(at.beams.values()), frames, n),
        scale_kind=scale_kind,
        scale=scale,
        contact_par=contact_numbers(at, instances, contacts, arms),
        reach=min(size, max(arms[1:], default=size)),
    )


def looked_at(m: int, n: int) -> dict[str, Any]:
    """What tells a model how it is solved, of one whose m rows are only looked at."""
    return {**no_pattern(m, n), "near": 0.0, "near_rows": 0.0, "looped": NONE_OF_THEM}


def solved(
    at: Addresses, instances: list[Instance], rows: list[RowName], hubs: Hubs, of: Masses
) -> dict[str, Any]:
    """The same of one that is."""
    solver, bars = at.scenario.solver, spans(at)
    return {
        **pattern([r.frames for r in rows], len(at.frames), bars, hubs),
        "near": near(solver, rows, bars),
        "near_rows": 0.0 if len(of.light) else near_rows(solver, rows, bars),
        "looped": looped(instances, rows, bars),
    }


def as_drawn(parts: Parts, rows: list[RowName]) -> tuple[Scene, NDArray[np.float64]]:
    """The scene with some rows in space, its angles on the turns of the drawing (from others a row
    that relates angles is far from closed), and its state."""
    full = scene(build(parts, rows, 6))
    full.mem[:, PHASE] = UNLOCATED
    for x in parts.at.coordinates.values():
        full.branch[x.entry] = x.drawn
    return full, drawn(parts.at, 6)


def spans(at: Addresses) -> list[tuple[int, int]]:
    """First frame and number of nodes of every flexible bar."""
    return [(beam.first, beam.nodes) for beam in at.beams.values()]
