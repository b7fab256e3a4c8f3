//! The fabrics that come with the crate.

use std::path::Path;

use bevy::{prelude::*, reflect::Typed};
use bevy_drape::prelude::*;

use crate::{common::*, fabric_assets::wait_for};

const GRID: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::new(4, 4), lying: false };

#[test]
fn presets_are_valid_and_say_what_of_them_was_measured() {
    let fields = Fabric::type_info().as_struct().unwrap().field_names();
    for preset in Fabric::PRESETS {
        let FabricPreset { name, measured, source, .. } = preset;
        assert!(preset.fabric.material().is_ok(), "{name}");
        assert!(measured.iter().all(|field| fields.contains(field)), "{name}: {measured:?}");
        assert!(measured.is_sorted_by_key(|field| fields.iter().position(|other| other == field)), "{name}");
        let about = preset.about();
        assert!(about.ends_with(&format!(". {source}")) && source.ends_with('.'), "{about}");
        assert_eq!(about.starts_with("Measured: density"), !measured.is_empty(), "{about}");
        assert!(about.contains("plausible"), "{about}");
    }
}

#[test]
fn the_files_of_presets_agree_with_them() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/fabrics");
    for preset in Fabric::PRESETS {
        let name = preset.name;
        let text = std::fs::read_to_string(folder.join(format!("{name}.fabric.ron"))).expect(name);
        let constant = name.to_uppercase();
        let comment = format!("// `Fabric::{constant}`. The docs of `Fabric` have units and ranges.\n");
        let expected = format!("{comment}// {}\n{}", preset.about(), preset.fabric.to_ron());
        assert_eq!(text.replace('\r', ""), expected, "{name}");
    }
    assert_eq!(std::fs::read_dir(folder).unwrap().count(), Fabric::PRESETS.len());
}

#[test]
fn presets_differ_as_their_fabrics_do() {
    let rising = |field: fn(&Fabric) -> f32, order: &[Fabric]| order.is_sorted_by(|a, b| field(a) < field(b));
    let [jersey, cotton, denim, tablecloth, silk, wool, leather, rubber] = Fabric::PRESETS.map(|preset| preset.fabric);
    assert_eq!(silk, Fabric::SILK, "they are in the order of their names here");
    let all = |order: [&Fabric; 8]| order.map(Clone::clone);
    let by_rigidity = all([&silk, &jersey, &tablecloth, &wool, &cotton, &denim, &rubber, &leather]);
    assert!(rising(|fabric| fabric.bending_rigidity, &by_rigidity));
    let by_stiffness = all([&jersey, &rubber, &wool, &silk, &denim, &cotton, &tablecloth, &leather]);
    assert!(rising(|fabric| fabric.weft_stiffness, &by_stiffness));
    let by_density = all([&silk, &tablecloth, &cotton, &jersey, &wool, &denim, &leather, &rubber]);
    assert!(rising(|fabric| fabric.density, &by_density));
    for fabric in by_density {
        assert!((0.0001..=0.001).contains(&fabric.thickness), "{fabric:?}");
    }
}

#[test]
fn presets_are_loaded_from_their_files() {
    let mut app = headless();
    for FabricPreset { name, fabric, .. } in Fabric::PRESETS {
        let handle = app.world().resource::<AssetServer>().load(format!("fabrics/{name}.fabric.ron"));
        let cloth = spawn_cloth(&mut app, GRID, FabricHandle::new(handle));
        wait_for(&mut app, |app| *get::<Fabric>(app, cloth) == fabric);
    }
}
