"""One line of a program as the scanner leaves it: a plain C structure, no Python objects."""

cdef enum:
    # Words by letter: 'a' is 0 .. 'z' is 25, then the three that are no letters.
    W_A = 0
    W_B = 1
    W_C = 2
    W_D = 3
    W_E = 4
    W_F = 5
    W_G = 6
    W_H = 7
    W_I = 8
    W_J = 9
    W_K = 10
    W_L = 11
    W_M = 12
    W_N = 13
    W_O = 14
    W_P = 15
    W_Q = 16
    W_R = 17
    W_S = 18
    W_T = 19
    W_U = 20
    W_V = 21
    W_W = 22
    W_X = 23
    W_Y = 24
    W_Z = 25
    W_DOLLAR = 26    # spindle
    W_AT = 27        # polar distance
    W_CARET = 28     # polar angle
    WORDS = 29

    G_GROUPS = 16
    M_GROUPS = 11
    LINE_SIZE = 255  # room for the characters of a line and the closing zero
    LINE_MAX = 252   # characters of a line of a program, as in LinuxCNC
    MAX_SETTINGS = 50
    MISSING = -1     # a P, Q or H word of this value counts as not written wherever LinuxCNC takes it so


cdef enum:
    # Masks of words
    M_AXES = (1 << W_X) | (1 << W_Y) | (1 << W_Z) | (1 << W_A) | (1 << W_B) | (1 << W_C) | (1 << W_U) | (1 << W_V) | (1 << W_W)
    M_XYZ = (1 << W_X) | (1 << W_Y) | (1 << W_Z)
    M_UVW = (1 << W_U) | (1 << W_V) | (1 << W_W)
    M_ABC = (1 << W_A) | (1 << W_B) | (1 << W_C)
    M_IJK = (1 << W_I) | (1 << W_J) | (1 << W_K)
    M_POLAR = (1 << W_AT) | (1 << W_CARET)


ctypedef struct Block:
    unsigned int words          # bit per word present
    double value[WORDS]
    short at[WORDS]             # where the word stands in the stripped line, for errors
    int g[G_GROUPS]             # G code times 10 per modal group, -1: none
    short g_at[G_GROUPS]
    int m[M_GROUPS]             # M code per modal group, -1: none
    short m_at[M_GROUPS]
    int m_count
    unsigned long long steps    # what there is to do, a bit per place in the order of execution
    int motion                  # motion code times 10 that this line performs, -1: none
    double n                    # line number, -1: none
    int comment                 # offset of the last comment's text in the stripped line, -1: none
    int comment_size


cdef inline bint has(const Block* b, int word) noexcept nogil:
    return (b.words >> word) & 1


cdef inline double value_or(const Block* b, int word, double default) noexcept nogil:
    return b.value[word] if (b.words >> word) & 1 else default
