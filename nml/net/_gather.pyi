"""Types of the compiled module ``_gather.pyx``."""

from array import array

def gather(image: bytes | bytearray | memoryview, index: array[int], template: bytes) -> bytes: ...
