"""Previews drawn with OpenGL, for displays such as AXIS: a program's path, its dwells, and where the tool has been.

``rs274.glcanon`` and ``positionlogger.call`` come here. A point has nine numbers, X to W; the geometry of the display
([DISPLAY]GEOMETRY) says how they make a place in the picture, letter by letter: a linear axis moves along its
direction, a rotary axis turns what the letters before it made, a minus reverses the letter behind it. OpenGL is looked
for when something is drawn first; ``linuxcnc.error`` where it is not installed.
"""

from libc.math cimport M_PI, ceil, cos, fabs, fmax, sin

from linuxcnc._connection import error

cdef extern from "dlfcn.h" nogil:
    void *dlopen(const char *path, int flags)
    void *dlsym(void *handle, const char *name)
    void *RTLD_DEFAULT
    int RTLD_NOW
    int RTLD_GLOBAL

ctypedef double[9] Point9

cdef enum:
    GL_LINES = 0x0001
    GL_LINE_STRIP = 0x0003
    GL_UNSIGNED_BYTE = 0x1401
    GL_FLOAT = 0x1406
    GL_VERTEX_ARRAY = 0x8074
    GL_COLOR_ARRAY = 0x8076

cdef struct OpenGL:
    void (*Begin)(unsigned int mode) noexcept nogil
    void (*End)() noexcept nogil
    void (*Vertex3dv)(const double *point) noexcept nogil
    void (*Vertex3f)(float x, float y, float z) noexcept nogil
    void (*Color4d)(double red, double green, double blue, double alpha) noexcept nogil
    void (*LoadName)(unsigned int name) noexcept nogil
    void (*VertexPointer)(int size, unsigned int type, int stride, const void *first) noexcept nogil
    void (*ColorPointer)(int size, unsigned int type, int stride, const void *first) noexcept nogil
    void (*EnableClientState)(unsigned int array) noexcept nogil
    void (*DrawArrays)(unsigned int mode, int first, int count) noexcept nogil

cdef struct Turning:
    bint about_offset  # turn about the work offset, else about the machine's origin
    double[3] offset  # inches; X, Y, Z of the work offset
    bint[3] turns  # which of A, B, C turn the picture

GL_NAMES = (  # in the order of OpenGL
    b"Begin", b"End", b"Vertex3dv", b"Vertex3f", b"Color4d", b"LoadName", b"VertexPointer", b"ColorPointer",
    b"EnableClientState", b"DrawArrays",
)

cdef OpenGL gl
cdef bint gl_found = False
cdef Turning turning = Turning(False, [0.0, 0.0, 0.0], [False, False, False])

cdef double DWELL_SIZE = 0.015625  # inches from the middle of a dwell's mark to its sides
cdef double STEP_DEG = 10.0  # a line with rotation is drawn in parts of at most this
cdef int FEWEST_STEPS = 10  # and in so many at least


cdef int find_gl() except -1:
    """Look the functions of OpenGL up."""
    global gl_found
    if gl_found:
        return 0
    if dlopen("libGL.so.1", RTLD_NOW | RTLD_GLOBAL) == NULL:
        dlopen("libOpenGL.so.0", RTLD_NOW | RTLD_GLOBAL)
    cdef void **functions = <void **>&gl
    cdef int number = 0
    for name in GL_NAMES:
        functions[number] = dlsym(RTLD_DEFAULT, b"gl" + name)
        if functions[number] == NULL:
            raise error("OpenGL is not installed: there is no libGL.so.1 to draw with")
        number += 1
    gl_found = True
    return 0


cdef int read_point(object numbers, double *point) except -1:
    cdef int axis
    if len(numbers) != 9:
        raise TypeError(f"a point has 9 numbers, not {len(numbers)}")
    for axis in range(9):
        point[axis] = numbers[axis]
    return 0


cdef void turn(int axis, double angle_deg, double *picture) noexcept nogil:
    """Turn what is in the picture about X, Y or Z (``axis`` 0 to 2)."""
    cdef int u = 1 if axis == 0 else 0, v = 1 if axis == 2 else 2
    cdef double angle = angle_deg * M_PI / 180.0
    cdef double c = cos(angle), s = sin(angle)
    if turning.about_offset:
        picture[u] -= turning.offset[u]
        picture[v] -= turning.offset[v]
    picture[u], picture[v] = picture[u] * c - picture[v] * s, picture[u] * s + picture[v] * c


cdef void place(const char *geometry, const double *point, double *picture) noexcept nogil:
    """Where a point lies in the picture."""
    cdef double sign = 1.0
    cdef char letter
    picture[0] = picture[1] = picture[2] = 0.0
    while geometry[0]:
        letter = geometry[0]
        geometry += 1
        if letter == c'-':
            sign = -1.0
        elif c'X' <= letter <= c'Z':
            picture[letter - c'X'] += sign * point[letter - c'X']
        elif c'U' <= letter <= c'W':
            picture[letter - c'U'] += sign * point[6 + letter - c'U']
        elif c'A' <= letter <= c'C' and turning.turns[letter - c'A']:
            turn(letter - c'A', sign * point[3 + letter - c'A'], picture)
        if c'A' <= letter <= c'C' or c'U' <= letter <= c'Z':
            sign = 1.0


cdef void draw_to(const char *geometry, const double *start, const double *end, bint strip) noexcept nogil:
    """Vertices from ``start`` to ``end``: of a strip only those behind the start, else two for each part."""
    cdef double rotation = fmax(fabs(end[3] - start[3]), fmax(fabs(end[4] - start[4]), fabs(end[5] - start[5])))
    cdef int steps = <int>fmax(FEWEST_STEPS, ceil(rotation / STEP_DEG)) if rotation else 1
    cdef int step, axis
    cdef double part
    cdef Point9 between
    cdef double[3] picture
    if not strip:
        place(geometry, start, picture)
        gl.Vertex3dv(picture)
    for step in range(1, steps + 1):
        part = <double>step / steps
        for axis in range(9):
            between[axis] = end[axis] * part + start[axis] * (1.0 - part)
        place(geometry, between, picture)
        gl.Vertex3dv(picture)
        if not strip and step < steps:
            gl.Vertex3dv(picture)


def gui_rot_offsets(double x, double y, double z) -> None:
    """Set the work offset (inches) that rotary axes turn about."""
    turning.offset = [x, y, z]


def gui_respect_offsets(str coordinates, int respect) -> None:
    """Whether rotary axes turn the picture about the work offset; if so, those of ``coordinates`` turn it."""
    turning.about_offset = respect != 0
    if respect:
        for number, letter in enumerate("ABC"):
            if letter in coordinates:
                turning.turns[number] = True


def vertex9(str geometry, point) -> tuple:
    """Where a point lies in the picture: x, y, z."""
    cdef Point9 numbers
    cdef double[3] picture
    read_point(point, numbers)
    text = geometry.encode()
    place(text, numbers, picture)
    return picture[0], picture[1], picture[2]


def line9(str geometry, start, end) -> None:
    """Draw a line as pairs of vertices, between glBegin(GL_LINES) and glEnd."""
    cdef Point9 first, last
    read_point(start, first)
    read_point(end, last)
    find_gl()
    text = geometry.encode()
    draw_to(text, first, last, strip=False)


def draw_lines(str geometry, list lines not None, int for_selection) -> None:
    """Draw moves, each (line number, start, end, ...), in strips; those of a line number have its name to be picked."""
    cdef Point9 first, last
    cdef double[3] picture
    cdef int name, drawn_name = -1, axis
    cdef bint follows, started = False
    find_gl()
    text = geometry.encode()
    cdef const char *letters = text
    try:
        for line in lines:
            name = line[0]
            read_point(line[1], first)
            follows = started
            for axis in range(9):
                follows = follows and first[axis] == last[axis]
            read_point(line[2], last)
            if for_selection and name != drawn_name:
                if started:
                    gl.End()
                    started = False
                gl.LoadName(name)
                drawn_name = name
                follows = False
            if not follows:
                if started:
                    gl.End()
                gl.Begin(GL_LINE_STRIP)
                started = True
                place(letters, first, picture)
                gl.Vertex3dv(picture)
            draw_to(letters, first, last, strip=True)
    finally:
        if started:
            gl.End()


cdef void draw_mark(double x, double y, double z, int plane) noexcept nogil:
    """A cross in the plane, 0: XY, 1: XZ, 2: YZ; each of its lines twice, so that it stands out."""
    cdef double d = DWELL_SIZE
    cdef double[4][2] corners = [[-d, -d], [d, d], [-d, d], [d, -d]]
    cdef int[8] order = [0, 1, 2, 3, 1, 0, 3, 2]
    cdef int number
    cdef double u, v
    if plane == 2:
        order = [0, 1, 3, 2, 1, 0, 2, 3]
    for number in order:
        u, v = corners[number][0], corners[number][1]
        if plane == 0:
            gl.Vertex3f(x + u, y + v, z)
        elif plane == 1:
            gl.Vertex3f(x + u, y, z + v)
        else:
            gl.Vertex3f(x, y + u, z + v)


cdef int draw_dwell(object dwell, double alpha, bint for_selection, bint is_lathe) except -1:
    cdef double red, green, blue, x, y, z
    cdef int plane
    name, (red, green, blue), x, y, z, plane = dwell
    if for_selection:
        gl.LoadName(name)
        gl.Begin(GL_LINES)
    else:
        gl.Color4d(red, green, blue, alpha)
    draw_mark(x, y, z, 1 if is_lathe else plane)
    if for_selection:
        gl.End()
    return 0


def draw_dwells(str geometry, list dwells not None, double alpha, int for_selection, int is_lathe) -> None:
    """Mark dwells, each (line number, (red, green, blue), x, y, z, plane); a lathe's always in the plane XZ."""
    cdef bint together = not for_selection
    find_gl()
    if together:
        gl.Begin(GL_LINES)
    try:
        for dwell in dwells:
            draw_dwell(dwell, alpha, for_selection, is_lathe)
    finally:
        if together:
            gl.End()


def draw_track(const unsigned char[::1] rows, int count, bint pairs) -> None:
    """Draw the tool's path: rows of 32 bytes, place (3 float32), colour (4 bytes), and both again for a second place.

    As a strip of first places; or, for ``pairs``, as a line from the first to the second place of each row.
    """
    cdef int stride = 16 if pairs else 32
    find_gl()
    if count <= 0 or rows.shape[0] < count * 32:
        return
    gl.VertexPointer(3, GL_FLOAT, stride, &rows[0])
    gl.ColorPointer(4, GL_UNSIGNED_BYTE, stride, &rows[12])
    gl.EnableClientState(GL_COLOR_ARRAY)
    gl.EnableClientState(GL_VERTEX_ARRAY)
    if pairs:
        gl.DrawArrays(GL_LINES, 0, 2 * count)
    else:
        gl.DrawArrays(GL_LINE_STRIP, 0, count)
