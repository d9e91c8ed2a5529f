"""Stress: contact problems far from comfortable, by every method, judged against the truth.

    python -m benchmarks.stress        run what is missing, then write docs/stress.md and its map

A *case* is a mechanism with a clearance, a restitution, a friction, a speed and a stiffness; a
*cell* is a case by one method at one tolerance, or step.  cells.py draws them, judge.py runs and
judges them, report.py tells of them.
"""
