"""Types of the command table; the texts are in ``commands.pyx``."""

COMMANDS: list[tuple[str, int, list[str], str]]
