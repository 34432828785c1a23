"""What the planner waits for, or is led by: spindles and the locks of indexers."""

from emcmot.state cimport Motion

cdef void synchronised_cycle(Motion* m) noexcept nogil
