"""Mills whose work lies on two rotary tables, one upon the other: three modules, which keep the tool on the work.

``xyzac-trt-kins`` and ``xyzbc-trt-kins``: a rotary table (c) upon a tilting one (a or b). ``xyzab_tdr_kins``: a table
about x (a) upon a table about y (b). The pose is the tool's place on the unturned work, and the joints x y z are where
the slides must take the tool when the work has turned. Pins: ``x-rot-point`` .. the centre of the tables, ``x-offset``
.. from there to the axis of the lower table, ``tool-offset`` the tool's length where it counts. Switchable to the
identity.
"""

from emcmot.kins.frames cimport turn_plane
from emcmot.kins.kinematics cimport (
    KINS_AXES,
    KINS_JOINTS,
    Kinematics,
    KinematicsModule,
    identity_forward,
    identity_inverse,
)

from emcmot.kins.kinematics import AXIS_LETTERS, joint_letters

cdef enum:               # parameters
    ROT_POINT = 0
    OFFSET = 3
    TOOL = 6

cdef enum:               # axes
    A = 3
    B = 4
    C = 5

TABLE_NAMES = ("x-rot-point", "y-rot-point", "z-rot-point", "x-offset", "y-offset", "z-offset", "tool-offset")
DUAL_NAMES = ("x-rot-point", "y-rot-point", "z-rot-point", "x-offset", "z-offset", "tool-offset-z")


cdef void move(double* p, const double* way, double times) noexcept nogil:
    cdef int i
    for i in range(3):
        p[i] += times * way[i]


cdef void tilt(double* p, int axis, double degrees) noexcept nogil:
    """Turn a point about the x axis (A) or the y axis (B)."""
    if axis == A:
        turn_plane(&p[1], &p[2], degrees)
    else:
        turn_plane(&p[2], &p[0], degrees)


cdef void tilt_offset(const Kinematics* kins, double* d) noexcept nogil:
    """From the centre of the rotary table to the axis of the tilting one."""
    d[0], d[1] = kins.parameter[OFFSET], kins.parameter[OFFSET + 1]
    d[2] = kins.parameter[OFFSET + 2] + kins.parameter[TOOL]


cdef int rotary_forward(const Kinematics* kins, double* joints, double* pose, int axis) noexcept nogil:
    cdef double d[3]
    identity_forward(kins, joints, pose)
    tilt_offset(kins, d)
    move(pose, &kins.parameter[ROT_POINT], -1.0)
    move(pose, d, -1.0)
    tilt(pose, axis, -pose[axis])
    move(pose, d, 1.0)
    turn_plane(&pose[0], &pose[1], -pose[C])
    move(pose, &kins.parameter[ROT_POINT], 1.0)
    return 0


cdef int rotary_inverse(const Kinematics* kins, double* joints, const double* pose, int axis) noexcept nogil:
    cdef double slides[KINS_AXES]
    cdef double d[3]
    cdef int i
    for i in range(KINS_AXES):
        slides[i] = pose[i]
    tilt_offset(kins, d)
    move(slides, &kins.parameter[ROT_POINT], -1.0)
    turn_plane(&slides[0], &slides[1], pose[C])
    move(slides, d, -1.0)
    tilt(slides, axis, pose[axis])
    move(slides, d, 1.0)
    move(slides, &kins.parameter[ROT_POINT], 1.0)
    return identity_inverse(kins, joints, slides)


cdef int ac_forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    return rotary_forward(kins, joints, pose, A)


cdef int ac_inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    return rotary_inverse(kins, joints, pose, A)


cdef int bc_forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    return rotary_forward(kins, joints, pose, B)


cdef int bc_inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    return rotary_inverse(kins, joints, pose, B)


cdef void dual_offsets(const Kinematics* kins, double* d, double* tool) noexcept nogil:
    """From the centre of both tables to the axis of the upper one, and the tool."""
    d[0], d[1], d[2] = kins.parameter[OFFSET], 0.0, kins.parameter[OFFSET + 1]
    tool[0], tool[1], tool[2] = 0.0, 0.0, kins.parameter[OFFSET + 2]


cdef int dual_forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double d[3]
    cdef double tool[3]
    identity_forward(kins, joints, pose)
    dual_offsets(kins, d, tool)
    move(pose, &kins.parameter[ROT_POINT], -1.0)
    move(pose, tool, -1.0)
    tilt(pose, B, pose[B])
    move(pose, d, -1.0)
    tilt(pose, A, pose[A])
    move(pose, d, 1.0)
    move(pose, tool, 1.0)
    move(pose, &kins.parameter[ROT_POINT], 1.0)
    return 0


cdef int dual_inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double slides[KINS_AXES]
    cdef double d[3]
    cdef double tool[3]
    cdef int i
    for i in range(KINS_AXES):
        slides[i] = pose[i]
    dual_offsets(kins, d, tool)
    move(slides, &kins.parameter[ROT_POINT], -1.0)
    move(slides, tool, -1.0)
    move(slides, d, -1.0)
    tilt(slides, A, -pose[A])
    move(slides, d, 1.0)
    tilt(slides, B, -pose[B])
    move(slides, tool, 1.0)
    move(slides, &kins.parameter[ROT_POINT], 1.0)
    return identity_inverse(kins, joints, slides)


def create(str tilting_axis, coordinates: str | None = None, sparm: str = "") -> KinematicsModule:
    """xyzac-trt-kins (``tilting_axis`` a) or xyzbc-trt-kins (b)."""
    name = f"xyz{tilting_axis}c-trt-kins"
    letters = joint_letters(name, coordinates, f"xyz{tilting_axis}c", KINS_JOINTS, repeats=True)
    axes = {joint: AXIS_LETTERS.index(letter) for joint, letter in enumerate(letters) if letter not in "xyz"}
    cdef KinematicsModule module = KinematicsModule(name, len(letters), [(pin, 0.0) for pin in TABLE_NAMES])
    if tilting_axis == "a":
        module.offer_switchable(ac_forward, ac_inverse, letters, sparm, axes)
    else:
        module.offer_switchable(bc_forward, bc_inverse, letters, sparm, axes)
    return module


def create_dual() -> KinematicsModule:
    """xyzab_tdr_kins: type 0 is the identity, type 1 follows the tables."""
    letters = "xyzab"
    cdef KinematicsModule module = KinematicsModule("xyzab_tdr_kins", len(letters), [(pin, 0.0) for pin in DUAL_NAMES])
    module.set_letters(letters)
    module.offer(identity_forward, identity_inverse, {n: n for n in range(5)}, linear=True)
    module.offer(dual_forward, dual_inverse, {3: 3, 4: 4})
    return module
