"""How the planner asks for joints that are not axes."""

cdef enum:
    TP_JOINTS = 16

ctypedef int (*TpInverse)(const void* kins, double* joints, double* pose) noexcept nogil     # pose -> joints; 0: solved
