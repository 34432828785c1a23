"""The tables that drive the interpreter: modal groups, order of execution, and one entry per code.

``codes`` fills the entries. The scanner looks up groups here, the executor steps and handlers, so both know nothing
of any particular code.
"""

from rs274ngc.block cimport *

cdef dict G_GROUP_STEP = {
    0: STEP_SETTING, 1: STEP_MOTION, 2: STEP_PLANE, 3: STEP_DISTANCE, 4: STEP_IJK_DISTANCE, 5: STEP_FEED_MODE,
    6: STEP_UNITS, 7: STEP_COMPENSATION, 8: STEP_TOOL_LENGTH, 10: STEP_RETRACT, 11: STEP_G92, 12: STEP_ORIGIN,
    13: STEP_CONTROL, 14: STEP_SPINDLE_MODE, 15: STEP_DIAMETER,
}
cdef dict M_GROUP_STEP = {
    M_CONTEXT: STEP_CONTEXT, M_STOP: STEP_STOP, M_OUTPUTS: STEP_OUTPUTS, M_CHANGE: STEP_CHANGE, M_SPINDLE: STEP_SPINDLE,
    M_COOLANT: STEP_COOLANT, M_OVERRIDES: STEP_OVERRIDES, M_USER: STEP_USER,
}
cdef int i

for i in range(LIMIT):
    g_group[i] = -1
for i in range(200):
    m_group[i] = -1
for i in range(STEPS):
    step_g[i] = step_m[i] = -1
for group, step in G_GROUP_STEP.items():
    step_g[<int>step] = group
    g_steps[<int>group] = 1ULL << <int>step
for group, step in M_GROUP_STEP.items():
    step_m[<int>step] = group
    m_steps[<int>group] = 1ULL << <int>step
g_steps[1] = 0              # the motion of a line is found when the whole line is known
step_g[STEP_DWELL] = 0
for i in range(WORDS):
    word_step[i] = 0
word_step[W_G] = word_step[W_M] = word_step[W_N] = word_step[W_O] = -1
word_step[W_F] = STEP_FEED
word_step[W_S] = STEP_SPEED
word_step[W_T] = STEP_TOOL
