//! Processes of structural mechanics.

mod outward_faces;
mod resultant;
mod nodal_conditions;
mod constraints_of_process;
mod bolt_section;
mod bolt_pretension_process;
mod rotation_vector;
mod reference_node;
mod rigid_body_mass;
mod rotation_stiffness;
mod large_rotation;
mod kinematic_coupling;
mod kinematic_coupling_process;
mod rigid_shape_facets;
mod rigid_shape_process;
mod distributing_coupling;
mod distributing_coupling_process;
mod local_axes;
mod distribute_load_on_surface_process;
mod assign_displacement_along_direction_process;
mod assign_ground_springs_process;
mod impose_rigid_movement_process;
mod set_cartesian_local_axes_process;
mod set_cylindrical_local_axes_process;
mod set_spherical_local_axes_process;
mod sprism_process;
