"""Mutations that change nothing anybody could see, each looked at: (file, line of text, new)."""

EQUIVALENT: dict[tuple[str, str, str], str] = {}
