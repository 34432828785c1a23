"""The face of a kinematics to motion: two functions over joint and pose arrays, and a little about them.

A pose is the nine axis coordinates x y z a b c u v w. Both functions return 0, or another number where no solution
exists (the output is then not to be used). ``forward`` finds the last known pose in ``pose``, as a first guess for
iterative solvers. Neither allocates or blocks: they run in the servo thread.
"""

cdef enum KinematicsType:
    KINEMATICS_IDENTITY = 1
    KINEMATICS_FORWARD_ONLY = 2
    KINEMATICS_INVERSE_ONLY = 3
    KINEMATICS_BOTH = 4

cdef enum:
    KINS_JOINTS = 16
    KINS_PARAMETERS = 64

cdef struct Kinematics

ctypedef int (*KinsFunction)(const Kinematics* kins, double* joints, double* pose) noexcept nogil

cdef struct Kinematics:
    int type                     # KinematicsType
    int joints                   # joints that it uses: 0 .. joints - 1
    int linear                   # joints are fixed sums of axes, so that axis limits can keep the joints' limits
    int axis_of_joint[16]        # where a joint is one axis: its index; else -1
    KinsFunction forward         # joints -> pose
    KinsFunction inverse         # pose -> joints
    int parameters
    double parameter[64]         # geometry, refreshed from HAL each period where it has pins


cdef class KinematicsModule:
    cdef Kinematics kins
    cdef readonly tuple parameter_names
    cdef readonly str name
    cdef public bint flexible            # works with fewer joints too: those that the machine has
    cdef readonly list pin_addresses   # HAL pins of the parameters, where it was loaded into a realtime host
