"""What the parts of `plasmac` share: the component's pins and state. See ``plasmac.pyx``.

Heights are in machine units, counts in units of the pin `offset-scale`, voltages in V.
"""

from libc.stdint cimport int32_t, uint8_t

from hal.cell cimport hal_pin

cdef enum:  # states, the values of `state-out`
    IDLE
    PROBE_HEIGHT
    PROBE_DOWN
    PROBE_UP
    ZERO_HEIGHT
    PIERCE_HEIGHT
    TORCH_ON
    ARC_OK
    PIERCE_DELAY
    PUDDLE_JUMP
    CUT_HEIGHT
    CUT_MODE_01
    CUT_MODE_2
    PAUSE_AT_END
    SAFE_HEIGHT
    MAX_HEIGHT
    END_CUT
    END_JOB
    TORCH_PULSE
    PAUSED_MOTION
    OHMIC_TEST
    PROBE_TEST
    SCRIBING
    CONSUMABLE_CHANGE_ON
    CONSUMABLE_CHANGE_OFF
    CUT_RECOVERY_ON
    CUT_RECOVERY_OFF
    STATES

cdef enum:  # why a state was left, the values of `stop-type-out`
    NO_STOP
    JOB_ENDED  # the program is idle
    CUT_ENDED  # the cut was given up or is done
    CUT_HELD  # the program is paused, or has to be

cdef enum:
    HISTORY = 1000  # readings

cdef struct Plasmac:
    hal_pin arc_fail_delay, arc_lost_delay, arc_max_starts, arc_ok_high, arc_ok_in, arc_ok_low
    hal_pin arc_voltage_in, arc_voltage_offset, arc_voltage_scale
    hal_pin axis_x_max_limit, axis_x_min_limit, axis_x_position
    hal_pin axis_y_max_limit, axis_y_min_limit, axis_y_position
    hal_pin axis_z_max_limit, axis_z_min_limit, axis_z_position
    hal_pin breakaway, consumable_change, cornerlock_enable, cornerlock_threshold, current_velocity
    hal_pin cut_feed_rate, cut_height, cut_recovery, cut_volts, cutting_start, debug_print, external_estop
    hal_pin feed_override, feed_reduction, feed_upm, float_switch, float_switch_travel, gcode_scale
    hal_pin height_override, height_per_volt, homed, ignore_arc_ok_0, ignore_arc_ok_1, kerf_width
    hal_pin laser_recovery_start, laser_x_offset, laser_y_offset, low_cut_volts, lowpass_frequency
    hal_pin machine_is_on, max_offset, mesh_arc_ok, mesh_enable, mode, motion_type, move_down, move_up, multi_tool
    hal_pin offset_probe_delay, offset_probe_x, offset_probe_y, offset_set_probe, offset_set_scribe, offsets_active
    hal_pin ohmic_max_attempts, ohmic_probe, ohmic_probe_enable, ohmic_probe_offset
    hal_pin ohmic_sense_in, ohmic_sense_off_delay, ohmic_sense_on_delay, ohmic_test
    hal_pin ok_sample_counts, ok_sample_threshold, override_jog, pause_at_end, paused_motion_speed
    hal_pin pid_d_gain, pid_i_gain, pid_p_gain, pierce_delay, pierce_height
    hal_pin probe_feed_rate, probe_final_speed, probe_start_height, probe_test
    hal_pin program_is_idle, program_is_paused, program_is_running, puddle_jump_delay, puddle_jump_height
    hal_pin requested_velocity, resolution, restart_delay, safe_height
    hal_pin scribe_arm_delay, scribe_on_delay, scribe_start, setup_feed_rate, skip_ihs_distance
    hal_pin spotting_start, spotting_threshold, spotting_time, target_samples
    hal_pin thc_auto, thc_delay, thc_disable, thc_enable, thc_feed_rate, thc_sample_counts, thc_sample_threshold
    hal_pin thc_threshold, torch_enable, torch_off, torch_pulse_start, torch_pulse_time, units_per_mm, use_auto_volts
    hal_pin voidlock_enable, voidlock_off_cycles, voidlock_on_cycles, voidlock_slope
    hal_pin x_offset, x_offset_current, xy_feed_rate, y_offset, y_offset_current, z_offset_current, zero_window
    hal_pin adaptive_feed, arc_ok_out, arc_voltage_out, consumable_changing, cornerlock_is_locked, current_feed_rate
    hal_pin cut_length, cut_recovering, cut_time, cutting_stop, feed_hold, jog_inhibit, laser_recovery_state
    hal_pin led_down, led_up, offset_scale, ohmic_enable, ohmic_sense_out, paused_motion, paused_time, pierce_count
    hal_pin probe_test_error, probe_time, program_pause, program_resume, program_run, program_stop
    hal_pin rapid_time, requested_feed_rate, run_time, safe_height_is_limited, scribe_arm, scribe_on, sensor_active
    hal_pin state_out, stop_type_out, target_volts, thc_active, thc_enabled, torch_on, torch_time, voidlock_is_locked
    hal_pin x_offset_counts, xy_offset_enable, y_offset_counts
    hal_pin z_height, z_offset_counts, z_offset_enable, z_relative
    # what it is doing
    int state, stepped, stop  # now; at the last step; why the last cut ended
    double dt  # s, the period
    double scale  # machine units, a count
    float rate  # counts a period for one machine unit a minute
    float timer  # s, of the state; times are counted down in single precision, so that they end in LinuxCNC's period
    hal_pin starter  # what asked for the cut
    uint8_t in_job, manual  # a program ran; the cut is by hand
    uint8_t resting, entered  # no step in this period; it is the state's first
    uint8_t was_running, held, told
    # where the axes go
    int32_t x_step, y_step  # counts a period
    int32_t x_target, y_target, z_target
    uint8_t moving  # to a new height-override
    # where the material is
    double zero  # its surface's height
    int32_t zero_counts, cut_change, climbed  # the offset there; by height control since, now and at most
    double known_x, known_y
    uint8_t zero_known, cut_well
    # probing
    float deploying  # s, until the probe is there
    int32_t ohmic_tries
    uint8_t ohmic, by_ohmic, early, retrying, too_low, probe_beside
    int32_t sensed_for  # periods in which the relay has said otherwise
    # the arc
    double volts, ok_volts  # filtered; with which the steady readings began
    float restart, lost_timer  # s, until it may be tried again; until a lost one is an error
    int32_t ok_readings, starts
    uint8_t arc_ok, losing, spotted
    # height control
    float delay  # s, until it begins
    double reading_sum, last_error, override, last_volts
    double history[HISTORY]  # V, a ring of the last readings
    int32_t newest, heard, readings  # place in it, how many there are; readings of the target
    int32_t void_on, void_off  # periods
    uint8_t has_target
