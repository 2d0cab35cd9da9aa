//! Processes of heat; each file is one, found by its own name.

mod apply_thermal_face_process;
