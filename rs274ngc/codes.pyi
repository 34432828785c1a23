"""Types of the table of codes: see codes.pyx."""

TABLE: list[tuple[str, int, str, str]]
UNUSED: tuple[tuple[int, str], ...]
