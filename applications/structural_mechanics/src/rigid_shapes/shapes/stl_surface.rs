//! Triangles of an STL file.

use zelus_core::register;

use crate::rigid_shapes::profile::ProfileFault;
use crate::rigid_shapes::rigid_shape::{RigidShape, RigidShapeEntry, ShapeRequest, ShapeSpace};
use crate::rigid_shapes::shape_facets::ShapeFacets;
use crate::rigid_shapes::stl;

struct StlSurface(ShapeFacets);

impl RigidShape for StlSurface {
    fn facets(&self, request: &ShapeRequest) -> Result<ShapeFacets, ProfileFault> {
        match request.space {
            ShapeSpace::Solid => Ok(self.0.clone()),
            ShapeSpace::Plane | ShapeSpace::Revolution => Err(ProfileFault {
                fact: "an STL file has triangles in space, and the model is planar",
                remedy: "name \"extrusion\" or \"revolution\" and give the profile",
            }),
        }
    }
}

register! { RigidShapeEntry "stl",
    about: "triangles of an STL file, which enclose the rigid body",
    source: "STL, ASCII or binary",
    defaults: include_str!("../../../../../configs/rigid_shapes/stl.json"),
    build: |settings, folder| {
        let (name, scale) = (settings.get_str("file_name")?, settings.get_positive("scale")?);
        let place = settings.key_place("file_name");
        let facets = stl::read(&folder.join(name)).map_err(|problem| problem.at(place.clone()))?;
        if settings.get_bool("check_closed")? {
            stl::check_closed(&facets, name).map_err(|problem| problem.at(place))?;
        }
        Ok(Box::new(StlSurface(facets.moved(&|x| x.map(|c| scale * c)))))
    },
}
