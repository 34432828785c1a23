"""Types of the compiled module ``_gather.pyx``."""

import numpy as np
from numpy.typing import NDArray

def gather(image: bytes | bytearray | memoryview, runs: NDArray[np.int32], template: bytes) -> bytes: ...
