"""Refuses compiled modules that were built with different layouts of the memory that they share.

Each extension module that works on such a structure reports its size when it is imported. A module of an older build
then ends the import with a message, instead of writing beside what it means.
"""

from __future__ import annotations

_sizes: dict[str, tuple[str, int]] = {}  # structure -> who reported it first, bytes


def same_size(module: str, structure: str, size: int) -> None:
    """ImportError where another module reported another size for this structure."""
    first, known = _sizes.setdefault(structure, (module, size))
    if known != size:
        raise ImportError(
            f"{module} was built with {size} bytes for {structure}, {first} with {known}: they are not of one build; "
            "build the package emcmot again"
        )
