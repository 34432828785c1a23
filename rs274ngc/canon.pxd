"""C face of the canon: see canon.pyx."""


cdef class Canon:
    cdef public bint block_delete, optional_stop, is_task
    cpdef void init_canon(self) except *
    cpdef void set_g5x_offset(self, int index, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *
    cpdef void set_g92_offset(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *
    cpdef void set_xy_rotation(self, double theta) except *
    cpdef void use_tool_length_offset(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *
    cpdef void use_length_units(self, int units) except *
    cpdef void select_plane(self, int plane) except *
    cpdef void set_feed_reference(self, int reference) except *
    cpdef void set_feed_rate(self, double rate) except *
    cpdef void set_feed_mode(self, int spindle, int mode) except *
    cpdef void set_traverse_rate(self, double rate) except *
    cpdef void set_motion_control_mode(self, int mode, double tolerance) except *
    cpdef void set_naivecam_tolerance(self, double tolerance) except *
    cpdef void update_end_point(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *
    cpdef void straight_traverse(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *
    cpdef void straight_feed(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *
    cpdef void arc_feed(self, int line, double first_end, double second_end, double first_axis, double second_axis, int rotation, double axis_end, double a, double b, double c, double u, double v, double w) except *
    cpdef void nurbs_feed(self, int line, list control_points, int order) except *
    cpdef void nurbs_knots_feed(self, int line, list control_points, list knots, int order) except *
    cpdef void straight_probe(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, int probe_type) except *
    cpdef void rigid_tap(self, int line, double x, double y, double z, double scale) except *
    cpdef void start_speed_feed_synch(self, int spindle, double feed_per_revolution, bint velocity_mode) except *
    cpdef void stop_speed_feed_synch(self) except *
    cpdef void dwell(self, double seconds) except *
    cpdef void stop(self) except *
    cpdef void home_cycle(self) except *
    cpdef void home_cycle_joint(self, int joint) except *
    cpdef void set_spindle_mode(self, int spindle, double css_max) except *
    cpdef void set_spindle_speed(self, int spindle, double speed) except *
    cpdef void start_spindle_clockwise(self, int spindle, bint wait_for_atspeed) except *
    cpdef void start_spindle_counterclockwise(self, int spindle, bint wait_for_atspeed) except *
    cpdef void stop_spindle_turning(self, int spindle) except *
    cpdef void orient_spindle(self, int spindle, double orientation, int mode) except *
    cpdef void wait_spindle_orient_complete(self, int spindle, double timeout) except *
    cpdef void lock_spindle_z(self) except *
    cpdef void use_spindle_force(self) except *
    cpdef void use_no_spindle_force(self) except *
    cpdef void spindle_retract(self) except *
    cpdef void spindle_retract_traverse(self) except *
    cpdef void select_tool(self, int tool) except *
    cpdef void start_change(self) except *
    cpdef void change_tool(self) except *
    cpdef void change_tool_number(self, int pocket) except *
    cpdef void set_tool_table_entry(self, int pocket, int tool, double x, double y, double z, double a, double b, double c, double u, double v, double w, double diameter, double frontangle, double backangle, int orientation) except *
    cpdef void reload_tooldata(self) except *
    cpdef void set_cutter_radius_compensation(self, double radius) except *
    cpdef void start_cutter_radius_compensation(self, int side) except *
    cpdef void stop_cutter_radius_compensation(self) except *
    cpdef void flood_on(self) except *
    cpdef void flood_off(self) except *
    cpdef void mist_on(self) except *
    cpdef void mist_off(self) except *
    cpdef void enable_feed_override(self) except *
    cpdef void disable_feed_override(self) except *
    cpdef void enable_speed_override(self, int spindle) except *
    cpdef void disable_speed_override(self, int spindle) except *
    cpdef void enable_adaptive_feed(self) except *
    cpdef void disable_adaptive_feed(self) except *
    cpdef void enable_feed_hold(self) except *
    cpdef void disable_feed_hold(self) except *
    cpdef void set_motion_output_bit(self, int index) except *
    cpdef void clear_motion_output_bit(self, int index) except *
    cpdef void set_aux_output_bit(self, int index) except *
    cpdef void clear_aux_output_bit(self, int index) except *
    cpdef void set_motion_output_value(self, int index, double value) except *
    cpdef void set_aux_output_value(self, int index, double value) except *
    cpdef void lock_rotary(self, int line, int joint) except *
    cpdef void unlock_rotary(self, int line, int joint) except *
    cpdef void turn_probe_on(self) except *
    cpdef void turn_probe_off(self) except *
    cpdef void clamp_axis(self, int axis) except *
    cpdef void unclamp_axis(self, int axis) except *
    cpdef void comment(self, str text) except *
    cpdef void message(self, str text) except *
    cpdef void print_text(self, str text) except *
    cpdef void log(self, str text) except *
    cpdef void logopen(self, str name) except *
    cpdef void logappend(self, str name) except *
    cpdef void logclose(self) except *
    cpdef void probeopen(self, str name) except *
    cpdef void probeclose(self) except *
    cpdef void error(self, str text) except *
    cpdef void program_stop(self) except *
    cpdef void optional_program_stop(self) except *
    cpdef void pallet_shuttle(self) except *
    cpdef void program_end(self) except *
    cpdef void finish(self) except *
    cpdef void on_reset(self) except *
    cpdef void user_command(self, int number, double p, double q) except *
    cpdef void update_tag(self, object tag) except *
    cpdef tuple get_external_position(self)
    cpdef tuple get_external_probe_position(self)
    cpdef int get_external_probe_tripped_value(self) except? -1
    cpdef double get_external_probe_value(self) except? -1
    cpdef double get_external_feed_rate(self) except? -1
    cpdef double get_external_traverse_rate(self) except? -1
    cpdef double get_external_length_units(self) except? -1
    cpdef double get_external_angle_units(self) except? -1
    cpdef int get_external_length_unit_type(self) except? -1
    cpdef int get_external_motion_control_mode(self) except? -1
    cpdef double get_external_motion_control_tolerance(self) except? -1
    cpdef double get_external_motion_control_naivecam_tolerance(self) except? -1
    cpdef int get_external_plane(self) except? -1
    cpdef int get_external_axis_mask(self) except? -1
    cpdef int get_external_spindle(self, int spindle) except? -1
    cpdef double get_external_speed(self, int spindle) except? -1
    cpdef int get_external_flood(self) except? -1
    cpdef int get_external_mist(self) except? -1
    cpdef int get_external_queue_empty(self) except? -1
    cpdef tuple get_external_tool_offset(self)
    cpdef int get_external_tool_slot(self) except? -1
    cpdef int get_external_selected_tool_slot(self) except? -1
    cpdef object get_external_tool_table(self, int index)
    cpdef int get_external_tool_index(self, int tool) except? -1
    cpdef int get_external_pockets_max(self) except? -1
    cpdef int get_external_tc_fault(self) except? -1
    cpdef int get_external_tc_reason(self) except? -1
    cpdef int get_external_feed_override_enable(self) except? -1
    cpdef int get_external_spindle_override_enable(self, int spindle) except? -1
    cpdef int get_external_adaptive_feed_enable(self) except? -1
    cpdef int get_external_feed_hold_enable(self) except? -1
    cpdef int get_external_digital_input(self, int index, int default) except? -1
    cpdef double get_external_analog_input(self, int index, double default) except? -1
    cpdef int get_external_offset_applied(self) except? -1
    cpdef tuple get_external_offsets(self)
    cpdef object get_external_parameter(self, str name)
    cpdef bint get_block_delete(self) except *
    cpdef bint get_optional_program_stop(self) except *
    cpdef int wait(self, int index, int input_type, int wait_type, double timeout) except? -1
    cpdef bint user_command_exists(self, int number) except *
