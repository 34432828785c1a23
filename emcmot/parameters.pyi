"""Types of the parameter table; the texts are in ``parameters.pyx``."""

PARAMETERS: list[tuple[str, str, str, str]]
