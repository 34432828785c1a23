"""The face of a kinematics to motion: two functions over joint and pose arrays, and a little about them.

A pose is the nine axis coordinates x y z a b c u v w. Both functions return 0, or another number where no solution
exists (the output is then not to be used). ``forward`` finds the last known pose in ``pose``, as a first guess for
iterative solvers, and leaves axes alone that no joint moves; ``inverse`` finds the joints' positions in ``joints``, to
choose the nearest of several solutions. Neither allocates or blocks: they run in the servo thread.

A module may offer several ways to compute (switchable kinematics); motion.switchkins-type selects one.
"""

cdef enum KinematicsType:
    KINEMATICS_IDENTITY = 1
    KINEMATICS_FORWARD_ONLY = 2
    KINEMATICS_INVERSE_ONLY = 3
    KINEMATICS_BOTH = 4

cdef enum:
    KINS_JOINTS = 16
    KINS_AXES = 9
    KINS_PARAMETERS = 96
    KINS_OUTPUTS = 24
    KINS_WAYS = 3

cdef struct Kinematics

ctypedef int (*KinsFunction)(const Kinematics* kins, double* joints, double* pose) noexcept nogil

cdef struct KinsWay:
    KinsFunction forward         # joints -> pose
    KinsFunction inverse         # pose -> joints
    int linear                   # joints are fixed sums of axes, so that axis limits can keep the joints' limits
    int axis_of_joint[KINS_JOINTS]   # where a joint is one axis: its index; else -1

cdef struct Kinematics:
    int type                     # KinematicsType
    int joints                   # joints that it uses: 0 .. joints - 1
    int linear                   # these four are those of the way in use
    int axis_of_joint[KINS_JOINTS]
    KinsFunction forward
    KinsFunction inverse
    int ways
    int way                      # in use
    KinsWay offered[KINS_WAYS]
    double selected[KINS_WAYS]   # 1 for the way in use, for the pins kinstype.is-N
    int letter_of_joint[KINS_JOINTS]     # coordinates=: axis index of each joint, where a way is made of such joints
    int parameters
    double parameter[KINS_PARAMETERS]    # geometry, refreshed from HAL each period where it has pins
    double* output               # what the module shows on pins


cdef int select_way(Kinematics* kins, int way) noexcept nogil   # 0, or -1 where there is no such way
cdef int identity_forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil
cdef int identity_inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil


cdef class KinematicsModule:
    cdef Kinematics kins
    cdef double outputs[KINS_OUTPUTS]
    cdef readonly str name
    cdef readonly tuple parameter_names
    cdef readonly tuple pins             # Value: parameters first, then outputs
    cdef public int fewest_joints        # it works with fewer joints than it has, down to these; 0: with all only
    cdef readonly list bindings          # HAL cells, where it was loaded into a realtime host
    cdef offer(self, KinsFunction forward, KinsFunction inverse, axes=*, bint linear=*)
    cdef set_letters(self, letters)
    cdef offer_switchable(self, KinsFunction forward, KinsFunction inverse, str coordinates, str sparm, axes=*)
