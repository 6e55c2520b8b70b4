# SPDX-License-Identifier: GPL-3.0-or-later
# Commands that work.
set(few --electrons 2 --size 8x8)

semsurf_cli_test(version ARGS --version STDOUT "semsurf ${PROJECT_VERSION}" "Embree [0-9]" "OpenImageIO [0-9]")
semsurf_cli_test(help ARGS --help STDOUT "simulate" "info" "materials" "completion" "Examples:")
semsurf_cli_test(help.groups ARGS --help
  STDOUT "\nSEM:\n  simulate" "\nAFM:\n  level" "\nAFM \\+ SEM:\n" "\nSurfaces and files:\n" "\nSet-up and study:\n")
semsurf_cli_test(help.sweep_join ARGS sweep join --help STDOUT "Usage: semsurf sweep join .*FOLDER" "semsurf sweep join mesa")
semsurf_cli_test(help.simulate ARGS simulate --help
  STDOUT "Specimen:" "Beam:" "Scan:" "Simulation:" "Output:" "bare lengths are nm" "Examples:")
semsurf_cli_test(help.simulate_inputs ARGS simulate --help STDOUT "3MF, VTP, VTM.*\n.*scan, EXR.*scene file")
semsurf_cli_test(help.info ARGS info --help STDOUT "Examples:")
semsurf_cli_test(help.materials ARGS materials --help STDOUT "Examples:")
foreach(action list build plot remove)
  semsurf_cli_test(help.library.${action} ARGS library ${action} --help STDOUT "--cache FOLDER" "Examples:")
endforeach()
semsurf_cli_test(help.library ARGS library --help STDOUT "list.*\n.*build" "Examples:" "4 GB")
semsurf_cli_test(help.completion ARGS completion --help STDOUT "Examples:")
semsurf_cli_test(no_arguments EXIT 2 ARGS simulate STDERR "no specimen")

semsurf_cli_test(materials ARGS materials STDOUT "Si +2\\.33" "Au")
semsurf_cli_test(materials.all ARGS materials STDOUT "PMMA +1\\.19.*fitted" "Fe +7\\.87.*\\*  estimated" "Si .* fitted")
semsurf_cli_test(materials.estimated ARGS materials SiO2
  STDOUT "O, Z = 8, 53\\.2.* 2 per formula unit" "unfitted" "estimated: .*fitted to measured SE")
semsurf_cli_test(materials.own ARGS materials nitride --materials materials.toml
  STDOUT "work function W +6\\.3 eV\n    estimated: band gap plus" "N, Z = 7" "estimated: sum of the")
semsurf_cli_test(materials.no_gap ARGS materials nitride --materials no_gap.toml
  STDERR "warning: nitride: it is taken for a metal, as its band_gap_ev is not given, but most compounds with N ")
semsurf_cli_test(simulate.no_gap ARGS simulate cube.off --material nitride --materials no_gap.toml ${few} -o cube.exr
  STDERR "nitride: it is taken for a metal" "nitride: these numbers are estimates: valence_electrons, plasmon_ev, work_function_ev, barrier_ev"
  WRITES cube.exr)
semsurf_cli_test(simulate.speck ARGS simulate cube.off --material Au --energy 30keV ${few} -o cube.exr
  STDERR "warning: the specimen is 40.0 nm wide, but electrons of 30000 eV reach about 1.69 um in Au.*With --unit um it would be 40.0 um"
  WRITES cube.exr)
semsurf_cli_test(materials.own_table ARGS materials --materials materials.toml
  STDOUT "nitride +3\\.17" "Au +15 " STDERR "note: Au is as materials.toml says, in place of the built-in")
semsurf_cli_test(materials.one ARGS materials Si STDOUT "Z = 14" "work function" "Mott table +yes")

semsurf_cli_test(info.mesh ARGS info cube.off open.off --unit um
  STDOUT "12 triangles" "40.* wide, 40.* deep" "volume +6\\.4e\\+04 um.3" "cannot be simulated")
semsurf_cli_test(level.many ARGS level scan.txt flat.txt --height-pitch 2nm -o many/
  STDOUT "scan.txt\n" "written +many/scan.gsf" "flat.txt\n" WRITES many/scan.gsf many/flat.gsf)
semsurf_cli_test(level.all_but_the_bad EXIT 3 ARGS level nowhere.spm steps.txt --step 0,0,1,1 3,3,4,4
  STDOUT "steps.txt\nplane" STDERR "nowhere.spm")
semsurf_cli_test(clean.to_folder ARGS clean scan.txt --median 3 -o many/ WRITES many/scan.gsf)
semsurf_cli_test(erode.to_folder ARGS erode steps.txt --tip tip.txt -o many/ STDOUT "eroded +heights" WRITES many/steps.gsf)
semsurf_cli_test(survey.table ARGS survey scan.txt --no-tip -o table.csv STDOUT "roughness .*, noise " "written +table.csv" WRITES table.csv)
semsurf_cli_test(survey.all_but_the_bad EXIT 3 ARGS survey nowhere.spm scan.txt --no-tip STDOUT "scan.txt: roughness" STDERR "nowhere.spm")
semsurf_cli_test(info.json ARGS info --json cube.off scan.txt
  STDOUT "^.\n.\n" "\"kind\": \"mesh\"" "\"triangles\": 12" "\"kind\": \"heights\"" "\n.\n.\n$")
semsurf_cli_test(info.json_all_but_the_bad EXIT 3 ARGS info --json nowhere.stl cube.off
  STDOUT "^.\n.\n" "\"kind\": \"mesh\"" "\n.\n.\n$" STDERR "nowhere.stl")
semsurf_cli_test(version.json ARGS --version --json STDOUT "\"semsurf\": \"[0-9.]+\"" "\"instruction_set\": ")
semsurf_cli_test(info.mesh_faults ARGS info open.off
  STDOUT "open: [0-9]+ boundary edge.* near \\(" "try +semsurf mesh open.off --repair -o open_repaired.ply")
semsurf_cli_test(info.mesh_too_wide ARGS info cube.off --unit m
  STDOUT "40.0 m wide. is --unit right. With --unit um it would be 40.0 um")
semsurf_cli_test(info.mesh_too_narrow ARGS info cube.off --unit 0.01nm
  STDOUT "0.400 nm wide. is --unit right. With --unit um it would be 40.0 um")

semsurf_cli_test(mesh.convert ARGS mesh cube.off -o cube.ply
  STDOUT "shape +closed, 12 triangles" "size +40.0 nm wide" WRITES cube.ply INFO cube.ply "40.0 nm wide")
semsurf_cli_test(mesh.units ARGS mesh cube.off --unit um --scale 0.5 --out-unit nm -o cube.stl
  STDOUT "20.0 um wide" WRITES cube.stl INFO cube.stl "20.0 um wide")
semsurf_cli_test(mesh.repair ARGS mesh open.off --repair --max-hole 1um -o closed.obj
  STDOUT "repair +filled 1 hole with" "shape +closed" WRITES closed.obj INFO closed.obj "closed, ")
semsurf_cli_test(mesh.repair_leaves_open ARGS mesh open.off --repair -o out.ply
  STDOUT "left open: a hole of 4 edges, 160 nm round" STDERR "add --max-hole 160.2nm" WRITES out.ply)
semsurf_cli_test(mesh.repair_nothing ARGS mesh cube.off --repair -o cube.off.ply STDOUT "nothing to mend")
semsurf_cli_test(mesh.open_warns ARGS mesh open.off -o out.ply STDERR "Try --repair" WRITES out.ply)
semsurf_cli_test(mesh.simplify ARGS mesh "${PROJECT_SOURCE_DIR}/samples/pyramid.stl" --simplify 0.1nm
  -o small.ply STDOUT "simplify +[0-9]+ triangles to [0-9]+" WRITES small.ply)
semsurf_cli_test(mesh.smooth ARGS mesh cube.off --smooth 3 -o cube.ply -q STDOUT "^$" WRITES cube.ply)
semsurf_cli_test(mesh.scan ARGS mesh block.gsf --mesh-tolerance 0.1nm -o block.glb
  STDOUT "nowhere more than .* \\(proven\\)" "with height, curvature" "scale +1 nm is 1.00 mm" WRITES block.glb
  INFO block.glb "scalar +curvature, (.|\n)*command +mesh(.|\n)*option.mesh.mesh_tolerance_nm +0.1")
semsurf_cli_test(mesh.scan_to_count ARGS mesh steps.txt --triangles 100 -o steps.ply
  STDOUT "simplify +[0-9]+ triangles to (99|100)," WRITES steps.ply)
semsurf_cli_test(mesh.scan_missed ARGS mesh steps.txt --triangles 20 --tolerance 0.001nm -o steps.ply
  STDERR "more than --mesh-tolerance" WRITES steps.ply)
semsurf_cli_test(mesh.solid ARGS mesh block.gsf --solid --thickness 7nm -o block.stl
  STDOUT "a base 7.00 nm under" "shape +closed" WRITES block.stl INFO block.stl "closed, ")
semsurf_cli_test(mesh.open_sheet ARGS mesh block.gsf -o block.3mf STDERR "which --solid makes of it" WRITES block.3mf)
semsurf_cli_test(mesh.on_the_surface ARGS mesh block.gsf --scalar block.gsf --drape block.gsf -o block.glb
  STDOUT "with height, curvature, height_of_block, the picture" WRITES block.glb INFO block.glb "picture +")
semsurf_cli_test(mesh.several ARGS mesh block.gsf steps.txt cube.off -o all.vtm
  STDOUT "shape +block: " "shape +steps: " "shape +cube: closed" WRITES all.vtm INFO all.vtm "mesh of 3 bodies")
semsurf_cli_test(mesh.loses_scalars ARGS mesh certain.ply --triangles 8 -o few.ply
  STDERR "its scalars and pictures are left out" WRITES few.ply)
semsurf_cli_test(mesh.keeps_scalars ARGS mesh certain.ply -o same.vtp STDOUT "with height, curvature, certain" WRITES same.vtp)
semsurf_cli_test(mesh.true_size ARGS mesh cube.off --true-size --z-exaggeration 5 -o cube.glb
  STDOUT "scale +true size.*5 times larger still" WRITES cube.glb INFO cube.glb "40.0 nm wide, 40.0 nm deep, 40.0 nm high")
semsurf_cli_test(mesh.magnified ARGS mesh cube.off --magnification 1e3 -o cube.stl
  STDOUT "1 nm is 1.00 um in the file" WRITES cube.stl INFO cube.stl "40.0 nm wide")
semsurf_cli_test(mesh.records ARGS mesh steps.txt --height-unit 2nm --height-pitch 3nmx4nm --scale 2 --mesh-tolerance 1pm --plain
  --out-unit um -o steps.glb WRITES steps.glb INFO steps.glb "option.mesh.mesh_tolerance_nm +0.001\n" "option.mesh.out_unit +1000nm\n"
  "option.mesh.plain +on\n" "option.mesh.scale +2\n" "option.scan.height_pitch_nm +3x4\n" "option.scan.height_unit_nm +2\n")
semsurf_cli_test(mesh.former_names ARGS mesh steps.txt --z-unit 2nm --pixel-size 3nm --tolerance 1pm -o steps.glb
  WRITES steps.glb INFO steps.glb "option.mesh.mesh_tolerance_nm +0.001\n" "option.picture.pixel_size_nm +3x3\n" "option.scan.height_unit_nm +2\n")
semsurf_cli_test(help.mesh ARGS mesh --help STDOUT "Repair:" "--mesh-tolerance LENGTH" "--height-pitch LENGTH" "Examples:")

semsurf_cli_test(info.scan ARGS info scan.txt
  STDOUT "heights, text matrix" "4 x 4 pixels of 10.0 nm x 15.0 nm" "1 Height +0 to 2, mean 0.4.* nm, 1 hole")
semsurf_cli_test(simulate.scan ARGS simulate flat.txt --height-channel Height --material Si --size 4x4
  --electrons 2 --channels z_nm -o scan.exr WRITES scan.exr INFO scan.exr "z_nm")

semsurf_cli_test(info.no_pixel_size ARGS info four.png
  STDOUT "size +4 x 4 pixels. the file does not say how large they are")
semsurf_cli_test(info.all_but_the_bad EXIT 3 ARGS info cube.off nowhere.stl scan.txt
  STDOUT "12 triangles(.|\n)*4 x 4 pixels of" STDERR "nowhere.stl: there is no such file")

semsurf_cli_test(info.gltf ARGS info two.gltf
  STDOUT "mesh of 2 bodies" "base, material Au, 12 triangles, 40.* wide, 40.* deep, 20.* high"
         "cap, material coating, 12 triangles, 16" "shape +closed, 24 triangles" "z 0 to 46 nm")
semsurf_cli_test(info.scene ARGS info scene.toml
  STDOUT "a cube of gold" "beam +energy 2keV" "8 x 8 pixels of 10" "3 per pixel" "in Au" "Joy")

semsurf_cli_test(simulate.mesh ARGS simulate cube.off ${few} -o cube.exr
  STDOUT "8 x 8 pixels" "SE +0\\.[0-9]+ ± 0" "BSE" "primaries +128" "cube.exr"
  STDERR "no --material is given: Si" WRITES cube.exr cube.run.json
  INFO cube.exr "specimen.body.1 +cube.off, Si, 12 triangles")
semsurf_cli_test(simulate.gltf ARGS simulate two.gltf --material C ${few} -o two.exr
  STDERR "two.gltf, cap: 'coating' is no known material: C"
  INFO two.exr "specimen.body.1 +two.gltf, base, Au,(.|\n)*specimen.body.2 +two.gltf, cap, C,")
semsurf_cli_test(simulate.all_formats ARGS simulate cube.off --material Au ${few}
  -o a/cube.exr -o a/cube.tif -o cube.png --channel BSE
  WRITES a/cube.exr a/cube.tif cube.png a/cube.run.json cube.run.json INFO a/cube.tif "BSE.stderr")
if(SEMSURF_VTK)
  semsurf_cli_test(simulate.vti ARGS simulate cube.off ${few} -o cube.vti
    WRITES cube.vti INFO cube.vti "SE.stderr")
endif()
semsurf_cli_test(simulate.quiet ARGS simulate cube.off ${few} -q -o cube.exr STDOUT "^$")
semsurf_cli_test(simulate.every_option ARGS simulate cube.off cube.off --material Si --unit nm
  --substrate Au --substrate-z -5nm --energy 0.5keV --tilt 0.3rad --azimuth 30 --spot 1nm
  --region -32,-32,32,32 --pixel-size 8nm --electrons 3 --seed 18446744073709551615
  --physics elastic=browning,secondaries=off,barrier=off --cutoff 60eV --threads 2 -o image.exr
  STDOUT "8 x 8 pixels" INFO image.exr "simulation.seed +18446744073709551615")
semsurf_cli_test(simulate.detectors ARGS simulate cube.off ${few} --detector quadrants
  --detector SE1 --detector loss:energy=400eV..,cone=30deg -o image.exr
  STDOUT "BSE-bottom +0" "SE1 +[01]" "loss +0" WRITES image.exr
  INFO image.exr "SE1.stderr(.|\n)*detector.8 +loss:energy=400eV")
semsurf_cli_test(simulate.extras ARGS simulate cube.off --substrate Si ${few} --spectra
  --trajectories 3 --trajectories-at 5,-5 --channels z_nm,normal,material -o image.exr
  WRITES image.spectra.csv image.tracks.png
  INFO image.exr "z_nm +40 to 40, mean(.|\n)*normal.z(.|\n)*material +1")
if(SEMSURF_VTK)
  semsurf_cli_test(simulate.deposit ARGS simulate cube.off --substrate Si ${few} --deposit 8
    --trajectories 2 -o image.vti WRITES image.deposit.vti image.tracks.vtp)
endif()
semsurf_cli_test(simulate.microscope ARGS simulate cube.off --substrate Si --size 8x8 --current 10pA
  --dwell 200ns --convergence 5mrad --focus 20nm --working-distance 4mm -o image.exr -o image.png
  STDOUT "12.48 primaries per pixel" WRITES image.png
  INFO image.exr "SE.shot(.|\n)*beam.convergence_deg +0.286")
semsurf_cli_test(simulate.sheet ARGS simulate sheet.off ${few} -o image.exr
  STDERR "taken as the top of a half-space")
semsurf_cli_test(simulate.negative_region ARGS simulate cube.off --region -.5,-96,96,96
  --electrons 1 --size 4x4 -o image.exr STDERR "one electron" INFO image.exr "scan.center_x_nm +47.75")
semsurf_cli_test(simulate.nothing_seen ARGS simulate cube.off --region 100,100,120,120
  --size 4x4 --electrons 2 -o image.exr STDERR "outside the specimen" "no pixel")
semsurf_cli_test(simulate.own_material ARGS simulate cube.off --materials materials.toml
  --material nitride --substrate Au ${few} -o cube.exr STDERR "Au is as materials.toml says"
  INFO cube.exr "input.1 +materials.toml sha256 [0-9a-f]+(.|\n)*material.1.estimated.plasmon_ev")
semsurf_cli_test(simulate.scene_own_material ARGS simulate own_material.toml --substrate brass ${few}
  -o cube.exr INFO cube.exr "material.1.name +brass(.|\n)*specimen.substrate +brass,")
semsurf_cli_test(info.own_material ARGS info own_material.toml STDOUT "in brass" "Z = 29: Browning")
semsurf_cli_test(info.scene_materials ARGS info scene.toml --materials materials.toml
  STDOUT "in Au" STDERR "Au is as materials.toml says")
semsurf_cli_test(simulate.scene ARGS simulate scene.toml -o image.exr
  STDOUT "8 x 8 pixels of 10" INFO image.exr "input.2 +cube.off sha256 [0-9a-f]+")
semsurf_cli_test(simulate.scene_overridden ARGS simulate scene.toml --energy 3keV --size 4x4
  --electrons 5 --seed 7 --substrate C -o image.exr
  STDOUT "4 x 4 pixels of 10" "primaries +80" INFO image.exr "beam.energy_ev +3000(.|\n)*specimen.substrate +C,")
semsurf_cli_test(simulate.scene_region ARGS simulate scene.toml --region -10,-10,10,10 -o image.exr
  STDOUT "8 x 8 pixels of 2.5")
semsurf_cli_test(simulate.interrupted EXIT 130 INTERRUPT WHEN *.checkpoint
  ARGS simulate cube.off --substrate Si --electrons 100000000 --size 4x4 --checkpoint-every 0.1s -o image.exr
  STDERR "interrupted" STDOUT "partial" WRITES image.exr image.run.json INFO image.exr "partial +true")

# Every sample runs, as it is but for its size.
file(GLOB samples CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/samples/*.toml")
foreach(sample IN LISTS samples)
  get_filename_component(name "${sample}" NAME_WE)
  semsurf_cli_test(sample.${name} ARGS simulate "${sample}" --electrons 2 --size 16x16
    -o image.exr -o image.png WRITES image.exr image.png INFO image.exr "title")
  semsurf_cli_test(sample.${name}.info ARGS info "${sample}" STDOUT "scene" "extent")
endforeach()

# Replay and accuracy: without secondaries cascades are short.
set(short --energy 500 --physics secondaries=off)
semsurf_cli_test(simulate.auto ARGS simulate cube.off --substrate Si ${few} -o image.exr
  STDOUT "method +direct: 128 primaries are too few for 10.2 thousand cascades"
  INFO image.exr "pixels.direct +64(.|\n)*simulation.method +direct")
semsurf_cli_test(simulate.replay ARGS simulate cube.off --substrate Si ${few} ${short}
  --method replay -o image.exr STDOUT "method +replay: as asked for" "library +10240 cascades.*made in"
  INFO image.exr "balance.handed_over(.|\n)*library.cascades +10240(.|\n)*simulation.method +replay")
semsurf_cli_test(simulate.accuracy ARGS simulate cube.off --substrate Si --size 8x8 ${short}
  --accuracy 20% --accuracy-floor 0.05 --method replay --channels model,electrons,variance_left -o image.exr
  STDOUT "pixels +.*differences to planes" "electrons +[0-9]+ per pixel on average" "accuracy +20 % reached"
  INFO image.exr "BSE.variance_left(.|\n)*simulation.accuracy_floor +0.05(.|\n)*simulation.method +replay")
semsurf_cli_test(simulate.accuracy_direct ARGS simulate cube.off --substrate Si --size 8x8 ${short}
  --accuracy 20% --accuracy-floor 0.05 -o image.exr
  STDOUT "method +direct: about .* are too few for" "pixels +100 % directly" "accuracy +20 % reached" WRITES image.exr)
semsurf_cli_test(simulate.time ARGS simulate cube.off --substrate Si --size 8x8 ${short}
  --time 1ms --cache cache -o image.exr STDERR "too short: even 10 % accuracy took" WRITES image.exr
  INFO image.exr "accuracy +0.1")
semsurf_cli_test(simulate.mesh_tolerance ARGS simulate rough.toml ${few} --mesh-tolerance 0.5nm -o image.exr
  STDOUT "simplified +rough: [0-9]+ triangles to [0-9]+, at most 0\\.[0-9]+ nm off" "0.500 nm allowed, took"
  STDERR "leaving out detail below 0.500 nm"
  INFO image.exr "simplified.1 +rough: (.|\n)*simulation.mesh_tolerance_nm +0.5")
semsurf_cli_test(simulate.mesh_tolerance_in_scene ARGS simulate rough.toml ${few} -o image.exr
  INFO image.exr "mesh_tolerance_nm +0.2")
semsurf_cli_test(simulate.mesh_tolerance_gains_nothing ARGS simulate cube.off ${few} --mesh-tolerance 1nm
  -o image.exr STDERR "cube.off: with --mesh-tolerance 1.00 nm nothing would be gained. it stays as it is"
  STDOUT "simplified +cube.off: as it is")
semsurf_cli_test(help.mesh_tolerance ARGS simulate --help STDOUT "--mesh-tolerance LENGTH")
semsurf_cli_test(help.accuracy ARGS simulate --help
  STDOUT "--accuracy-floor" "--time" "auto.direct.replay" "variance_left is the share")

# AFM scans: block.gsf is a tilted plane with a block of 5 nm on it, noisy.gsf AR(1) noise, plane.gsf all equal.
semsurf_cli_test(help.level ARGS level --help STDOUT "--level-method hough" "--level-degree N +Degree.* 0 to 6 .2." "--rows" "--step" "Examples:")
semsurf_cli_test(help.clean ARGS clean --help STDOUT "--spikes" "Examples:")
semsurf_cli_test(help.noise ARGS noise --help STDOUT "Usage: semsurf noise .OPTIONS. .COMMAND." "scan +The noise" "sem " "counts " "Examples:")
semsurf_cli_test(help.noise_scan ARGS noise scan --help STDOUT "--flat" "Examples:")
semsurf_cli_test(level.hough ARGS level block.gsf -o flat.gsf --substrate-mask substrate.tif
  STDOUT "plane +tilt 5\\.71" "substrate +[78][0-9]\\.[0-9] %" "roughness +all: Sa" "substrate: Sa" WRITES flat.gsf substrate.tif
  INFO flat.gsf "command +level" "option.level.method +hough" "option.level.degree +2")
semsurf_cli_test(level.sem_as_heights ARGS level fei.tif --height-unit 1nm --level-method plane -o flat.tif STDOUT "plane +tilt" WRITES flat.tif)
semsurf_cli_test(level.plane ARGS level block.gsf --level-method plane -o flat.tif STDOUT "plane +tilt" WRITES flat.tif)
semsurf_cli_test(level.polynomial ARGS level block.gsf --level-method polynomial --level-degree 1 --rows median -o levelled.txt
  STDOUT "rows +shifted by" WRITES levelled.txt)
semsurf_cli_test(level.step ARGS level block.gsf --level-method none --step 0,0,15,45 25,15,45,35
  STDOUT "step +5\\.00[0-9]* .+ 0\\.00.* nm, the second region above")
semsurf_cli_test(level.former_names ARGS level steps.txt --z-unit 1nm --pixel-size 2nmx3nm --channel 1 --method hough --tolerance 0.5nm
  --mask substrate.tif -o flat.gsf WRITES substrate.tif flat.gsf
  INFO flat.gsf "2.00 nm x 3.00 nm" "option.level.tolerance_nm +0.5" "option.scan.height_channel +1" "option.scan.height_pitch_nm +2x3"
       "option.scan.height_unit_nm +1" "input.1")
semsurf_cli_test(level.former_degree ARGS level block.gsf --method polynomial --degree 1 -o flat.gsf
  INFO flat.gsf "option.level.degree +1" "option.level.method +polynomial")
semsurf_cli_test(clean.own_limit ARGS clean noisy.gsf --spikes 3 -o clean.gsf STDOUT "spikes +[0-9]+ of"
  INFO clean.gsf "option.clean.spikes +3:[0-9.]+")
semsurf_cli_test(clean.all ARGS clean block.gsf --spikes 3:1nm --median 3 --disc --closing 5 -o clean.gsf
  STDOUT "spikes +[0-9]+ of [0-9]+ heights changed" "median " "closing " WRITES clean.gsf)
semsurf_cli_test(noise.flat ARGS noise scan noisy.gsf --flat --plot noise.svg
  STDOUT "noise +alpha 0\\.[0-9]+ ± .*sigma" "differences +alpha" "whiteness +along rows p" "normality +p" WRITES noise.svg)
semsurf_cli_test(noise.none ARGS noise scan plane.gsf --flat --degree 1 STDERR "no noise at all" STDOUT "noise +alpha")
semsurf_cli_test(noise.help_of_sem ARGS noise sem --help STDOUT "IMAGE FILE" "--flat-region RECTANGLE" "--block")
semsurf_cli_test(noise.help_of_counts ARGS noise counts --help STDOUT "SCENE FILE" "--trials")
semsurf_cli_test(noise.as_before ARGS noise noisy.gsf --flat --plot noise.svg STDOUT "noise +alpha" WRITES noise.svg)
semsurf_cli_test(noise.sem_as_before ARGS noise --sem steps_of_grey.tif --pixel-size 2nm --region 8nm,8nm,56nm,56nm --region 36,4,60,28
  --region 68,36,92,60 STDOUT "flat places +3 used")
semsurf_cli_test(noise.counts_as_before ARGS noise --counts scene.toml --electrons 5 --trials 200 --csv counts.csv
  STDOUT "200 trials" WRITES counts.csv)
semsurf_cli_test(noise.sem ARGS noise sem steps_of_grey.tif --plot noise.svg
  STDOUT "noise +variance = " "flat places +[0-9]+ used" "correlation +-?0\\.[0-9]+ along rows" WRITES noise.svg)
semsurf_cli_test(noise.sem_region ARGS noise sem steps_of_grey.tif --flat-region 4,4,28,28 --flat-region 36,4,60,28 --flat-region 68,36,92,60
  STDOUT "flat places +3 used")
semsurf_cli_test(noise.counts ARGS noise counts scene.toml --electrons 1,5 --trials 200 --at 0,0 --csv counts.csv --plot counts.svg
  STDOUT "200 trials" "SE of 5 +.*mean" "log-normal, median" WRITES counts.csv counts.svg)
semsurf_cli_test(noise.substrate ARGS noise scan noisy.gsf STDOUT "substrate +[0-9.]+ % of the image")
# AFM: a tip put into a surface and taken out of the scan.
foreach(command erode dilate open close certainty)
  semsurf_cli_test(help.${command} ARGS ${command} --help STDOUT "--tip FILE" "--height-channel NAME" "Examples:")
endforeach()
semsurf_cli_test(dilate ARGS dilate steps.txt --tip tip.txt -o scan.gsf
  STDOUT "scan +24 x 20 pixels" "tip +5 x 5" "dilated +heights" WRITES scan.gsf)
semsurf_cli_test(erode ARGS erode steps.txt --tip tip.txt --upsample 2 --threads 2 -o surface.gsf
  STDOUT "eroded +heights" WRITES surface.gsf INFO surface.gsf "option.morphology.upsample +2")
semsurf_cli_test(open ARGS open steps.txt --tip tip.txt --height-unit 2nm -o opened.gsf
  STDOUT "opened +heights" WRITES opened.gsf INFO opened.gsf "command +open" "option.scan.height_unit_nm +2" "input.2")
semsurf_cli_test(close ARGS close steps.txt --tip tip.txt -o closed.gsf STDOUT "closed +heights" WRITES closed.gsf)
semsurf_cli_test(erode.noncontact ARGS erode steps.txt --tip tip.txt --distance 2nm -o surface.txt WRITES surface.txt)
semsurf_cli_test(erode.resampled ARGS erode steps.txt --height-pitch 0.5nm --tip tip.txt -o surface.gsf
  STDERR "note: tip.txt: resampled from 5 x 5 pixels of 1.00 nm to 9 x 9" WRITES surface.gsf INFO surface.gsf "option.scan.height_pitch_nm +0.5")
semsurf_cli_test(certainty ARGS certainty steps.txt --tip tip.txt --height-noise 0.05nm -o map.png --eroded surface.gsf
  STDOUT "tolerance +contacts within 0.300 nm" "certain +[0-9.]+ % of the surface" WRITES map.png surface.gsf)
semsurf_cli_test(certainty.former_names ARGS certainty steps.txt --pixel-size 1nm --tip tip.txt --noise 0.05nm -o map.vti --surface surface.gsf
  WRITES map.vti surface.gsf INFO surface.gsf "option.scan.height_noise_nm +0.05" "option.scan.height_pitch_nm +1" "option.certainty.sigmas +3")
semsurf_cli_test(certainty.own_noise ARGS certainty steps.txt --tip tip.txt -o map.vti
  STDERR "a noise of .* is taken from neighbouring pixels" WRITES map.vti)
semsurf_cli_test(certainty.unexplained ARGS certainty steps.txt --tip tip.txt --height-noise 0 --neighbourhood 1 -o map.tif
  STDERR "cannot have been made by this tip" WRITES map.tif)
semsurf_cli_test(compare.same ARGS compare noisy.gsf noisy.gsf --registered --simulations 40 --no-picture -o change
  STDOUT "changes +none beyond the errors" WRITES change/report.json change/change.vti change/places.csv
  INFO change/change.vti "option.compare.registered +on" "command +compare")
semsurf_cli_test(compare.others EXIT 4 ARGS compare noisy.gsf block.gsf -o change
  STDERR "the surfaces (agree nowhere|fit as well|fit nearly)|they fit nearly" WRITES change/report.json)
# AFM: the tip itself.
semsurf_cli_test(help.tip ARGS tip --help STDOUT "--answer" "--shape SHAPE" "--also FILE" "Without --threshold")
semsurf_cli_test(tip.ball ARGS tip --shape ball:5nm --tip-size 15 -o tip.gsf STDOUT "15 x 15 samples" "down to -5.00 nm" WRITES tip.gsf)
semsurf_cli_test(tip.shape ARGS tip --shape cone:5nm,20deg --size 31 -o tip.gsf --plot tip.svg
  STDOUT "tip +31 x 31 samples" "radius " "half angle " WRITES tip.gsf tip.svg INFO tip.gsf "option.tip.shape +cone:5nm,20deg" "option.tip.size +31")
semsurf_cli_test(tip.turned ARGS tip --shape pyramid:5nm,20deg,3,30deg --tip-size 9 --height-pitch 2nm -o tip.gsf
  INFO tip.gsf "option.tip.shape +pyramid:5nm,20deg,3,30deg" "option.scan.height_pitch_nm +2")
semsurf_cli_test(tip.sweep ARGS tip steps.txt --tip-size 5 --height-noise 0.02nm --sweep 0.02nm,0.4nm,5 --plot tip.svg -o tip.gsf
  STDOUT "noise +" "threshold " WRITES tip.gsf tip.svg
  INFO tip.gsf "option.tip.sweep_nm +0.02,0.4,5" "option.tip.answer +sweep" "option.scan.height_noise_nm +0.02")
semsurf_cli_test(tip.doubted EXIT 4 ARGS tip steps.txt --tip-size 5 --height-noise 2nm --plot tip.svg -o tip.gsf
  STDOUT "radius +infinite: the tip is flat\n" "written +tip.gsf\n +tip.svg\n"
  STDERR "this tip is not to be trusted: its threshold of 16.0 nm is the largest that was tried.*it is flat"
  WRITES tip.gsf tip.svg INFO tip.gsf "tip.doubt +its threshold of 16.0 nm")
semsurf_cli_test(tip.noise_is_the_roughness EXIT 4 ARGS tip noisy.gsf --size 5 -o tip.gsf
  STDOUT "noise .*from differences of neighbouring rows and columns"
  STDERR "the noise of .* is most of the scan's roughness .Sq .*second differences of single pixels give" WRITES tip.gsf)
foreach(command erode dilate)
  semsurf_cli_test(${command}.doubted_tip ARGS ${command} steps.txt --tip doubted_tip.txt -o surface.gsf
    STDERR "warning: doubted_tip.txt: it says that this tip is not to be trusted: it is flat" WRITES surface.gsf)
endforeach()
semsurf_cli_test(certainty.doubted_tip EXIT 4 ARGS certainty steps.txt --tip doubted_tip.txt --height-noise 0.01nm -o map.tif
  STDOUT "certain +.* % of the surface, by the .* % of the scan that this tip can have made"
  STDERR "doubted_tip.txt: it says that this tip is not to be trusted" "cannot have been made by this tip.*so little of the scan is not to be trusted"
  WRITES map.tif)
semsurf_cli_test(register.doubted_tip EXIT 4 ARGS register --afm steps.txt --sem steps_of_grey.tif --pixel-size 3nm --height-pitch 3nm
  --level-method none --height-noise 0.1nm,0.5 --tip doubted_tip.txt --model secant.json
  STDERR "tip: it says that this tip is not to be trusted: it is flat")
semsurf_cli_test(register.former_names EXIT 4 ARGS register steps.txt steps_of_grey.tif --sem-pixel-size 3nm --afm-pixel-size 3nm
  --afm-channel 1 --afm-z-unit 1nm --no-level --afm-noise 0.5,0.01 --tip doubted_tip.txt --model secant.json
  STDERR "tip: it says that this tip is not to be trusted: it is flat")
semsurf_cli_test(tip.blind ARGS tip steps.txt --size 5 --threshold 0.1nm --apex-tolerance 0.1nm -o tip.gsf
  STDOUT "tip +5 x 5 samples" WRITES tip.gsf INFO tip.gsf "option.tip.answer +blind" "option.tip.apex_tolerance_nm +0.1" "option.tip.maxima +off")
semsurf_cli_test(tip.outer ARGS tip steps.txt --size 5 --answer outer --noise 0.05nm,0.5 -o tip.gsf
  STDOUT "at 95 % an outer bound" STDERR "does not tell the tip's shape" WRITES tip.gsf)
semsurf_cli_test(tip.best ARGS tip steps.txt --also steps.txt --size 5 --answer best --noise 0.05nm --plot best.png -o tip.gsf
  STDOUT "fit +misfit" WRITES tip.gsf best.png INFO tip.gsf "option.tip.answer +best" "option.tip.size +5")
semsurf_cli_test(tip.characterizer ARGS tip steps.txt --characterizer steps.txt --size 3 --search 2 -o tip.gsf
  STDOUT "known +found at sample" WRITES tip.gsf INFO tip.gsf "option.tip.answer +characterizer" "option.tip.search +2")
# SEM: a model's images against a microscope's.
semsurf_cli_test(help.calibrate ARGS calibrate --help STDOUT "--images FILE" "--range LENGTH" "Exit code 4" "Examples:")
semsurf_cli_test(calibrate ARGS calibrate four.png --pixel-size 1nm --images four.png --fit L --range 2nm -o fit.json --residual fit.exr
  STDOUT "gain L +1 ± " "condition +1" "100\\.00 % of the variance" WRITES fit.json fit.exr INFO fit.exr "calibrated" "option.calibration.range_nm +2" "option.calibration.fit +L" "option.scan.pixel_size_nm +1"
  "option.calibration.edge +mirror")
semsurf_cli_test(calibrate.model EXIT 4 ARGS calibrate steps.txt steps.txt --pixel-size 3nm --model secant.json -o fit.json
  STDERR "cannot be told apart: SE and BSE have a correlation of 1\\.0000.*fix the ratio" STDOUT "condition +infinite" WRITES fit.json)
semsurf_cli_test(calibrate.ratio ARGS calibrate four.png four.txt --pixel-size 3nm --model secant.json --ratio 0.5 -q -o fit.json
  WRITES fit.json)
semsurf_cli_test(calibrate.doubtful EXIT 4 ARGS calibrate four.png --pixel-size 1nm --images four.png --fit L --offset 1000 -o fit.json
  STDERR "the gain of L is below 0" STDOUT "offset +1000\n" WRITES fit.json)

if(WEB_PACKAGES)
  semsurf_cli_test(view ARGS view block.gsf -o page.html
    STDOUT "surface +block: [0-9]+ x [0-9]+ samples" "written +page.html, [0-9.]+ kB, of these" WRITES page.html)
  semsurf_cli_test(view.several ARGS view block.gsf block.gsf cube.off two.gltf four.png -o page.html
    STDOUT "surface +block 2:" "cube: 12 triangles" "cap: 12 triangles" "image +four.png: .*size not known" WRITES page.html)
  semsurf_cli_test(view.step ARGS view block.gsf --step 2 -o page.html STDERR "note: block.gsf: every second sample of"
    WRITES page.html)
  semsurf_cli_test(view.every ARGS view block.gsf --every 2 -o page.html STDERR "note: block.gsf: every second sample of"
    WRITES page.html)
  semsurf_cli_test(view.mesh_tolerance ARGS view block.gsf --mesh-tolerance 0.1nm --height-pitch 3nm -o page.html
    STDERR "triangles instead of [0-9]+, nowhere more than" WRITES page.html)
  semsurf_cli_test(view.tolerance ARGS view block.gsf --tolerance 0.1nm -o page.html
    STDERR "triangles instead of [0-9]+, nowhere more than" WRITES page.html)
  semsurf_cli_test(view.scalar_not_on_the_tip ARGS view block.gsf tip.txt --scalar block.gsf -o page.html
    STDOUT "surface +block: 60 x 50 samples, [^,]*, Height\n" "surface +tip: 5 x 5 samples, [^,]*\n"
    STDERR "note: tip: it is of another extent than 'Height' and goes without it" WRITES page.html)
  semsurf_cli_test(view.scalar ARGS view block.gsf --scalar plane.gsf --drape plane.gsf -o page.html -q STDOUT "^$" WRITES page.html)
endif()
semsurf_cli_test(help.view ARGS view --help STDOUT "--drape" "--scalar" "Examples:")

# A model on two small surfaces, and what is made of it.
set(small_model --pixel-size 3nm --surfaces 2 --surface-size 16 --electrons 2 --kind secant)
semsurf_cli_test(help.train ARGS train --help STDOUT "What the model is for:" "Kinds of models" "Examples:")
semsurf_cli_test(help.predict ARGS predict --help STDOUT "--model FILE.json" "Examples:")
semsurf_cli_test(train.own_surfaces ARGS train --material Si --energy 1keV ${small_model} -o si.json
  STDOUT "for +Si, 1 keV, pixels of 3.00 nm" "2 simulated, 0 there before, in si.training" "all learnt from .* %"
  WRITES si.json si.training/blocks.exr INFO si.json "command +semsurf train --material Si --surfaces 2 --surface-size 16 --pixel-size 3nm --kind secant")
semsurf_cli_test(train.hold_out ARGS train ${small_model} --hold-out 1 -o si.json
  STDOUT "island .held out." "all held out" STDERR "no --material is given: Si" WRITES si.json
  INFO si.json "1 surface, 256 pixels. 1 held out")
semsurf_cli_test(train.network ARGS train --pixel-size 3nm --surfaces 2 --surface-size 16 --electrons 2 --hidden 3,2 --iterations 9 --decay 1e-3 --model-error 5% -o si.json
  STDOUT "facet network, [0-9]+ neighbourhoods of 5 to [0-9]+ samples, sky in 6 bands to 169 nm, 3 and 2 hidden units, [0-9]+ numbers"
  WRITES si.json INFO si.json "cost +[0-9]")
semsurf_cli_test(train.slope_table ARGS train --pixel-size 3nm --kind slope-table-two-planes --table-electrons 50 -o si.json
  STDOUT "slope, a table in steps of 5 degrees. gives SE and BSE" WRITES si.json INFO si.json "50 at each angle")
semsurf_cli_test(train.slope_table_judged ARGS train --pixel-size 3nm --kind slope-table --table-electrons 50 --surfaces 2 --surface-size 16 --electrons 2 -o si.json
  STDOUT "2 simulated, 0 there before" "blocks .held out." "all held out" WRITES si.json INFO si.json "no images. 2 held out")
semsurf_cli_test(train.stopping_points ARGS train --pixel-size 3nm --kind stopping-points --table-electrons 50 -o si.json
  STDOUT "stopping points, 48 rings of" WRITES si.json INFO si.json "table.flat_se")
semsurf_cli_test(train.diffusion_matrix ARGS train --pixel-size 3nm --kind diffusion-matrix --table-electrons 50 -q -o si.json
  STDOUT "^$" WRITES si.json INFO si.json "diffusion matrix, 48 rings of")
semsurf_cli_test(train.record ARGS train --pixel-size 3nm --surfaces 2 --surface-size 16 --electrons 2 --kind filter-bank --least-eigenvalue 10% --seed 7 -q -o si.json
  STDOUT "^$" WRITES si.json
  INFO si.json "command +semsurf train --material Si --surfaces 2 --surface-size 16 --pixel-size 3nm --kind filter-bank --least-eigenvalue 10% --electrons 2 --seed 7"
  "option.simulation.seed +7" "option.training.least_eigenvalue +0.1" "option.training.surface_size +16" "option.beam.energy_ev +1000")
semsurf_cli_test(train.former_kind ARGS train --pixel-size 3nm --surfaces 2 --surface-size 16 --electrons 2 --model filter-bank --cut-off 10% -q -o si.json
  STDOUT "^$" WRITES si.json INFO si.json "option.training.kind +filter-bank" "option.training.least_eigenvalue +0.1")
semsurf_cli_test(train.former_tolerance ARGS train --pixel-size 3nm --surfaces 2 --surface-size 16 --electrons 2 --hidden 3 --iterations 2 --tolerance 5% -q -o si.json
  STDOUT "^$" WRITES si.json INFO si.json "option.training.model_error +0.05")
semsurf_cli_test(train.former_scan ARGS train four.txt --pitch 3nm --z-unit 2nm --signal four.png --model secant -q -o four.json
  STDOUT "^$" WRITES four.json INFO four.json "option.scan.height_pitch_nm +3" "option.scan.height_unit_nm +2")
semsurf_cli_test(train.heights ARGS train block.gsf --electrons 2 --kind ikeuchi-secant -q -o block.json
  STDOUT "^$" WRITES block.json block.training/block.exr INFO block.json "gives SE and BSE")
semsurf_cli_test(train.signal ARGS train four.txt --height-pitch 3nm --signal four.png --kind secant -o four.json
  STDOUT "gives signal" WRITES four.json)
semsurf_cli_test(train.interrupted EXIT 130 INTERRUPT ARGS train --pixel-size 3nm --electrons 100000 --kind secant -o si.json
  STDERR "stopped: there is no model yet.*same command goes on")
semsurf_cli_test(predict.scan ARGS predict steps.txt --height-pitch 3nm --model secant.json --material Si --energy 1keV -o image.exr -o image.png
  STDOUT "model +slope. gives SE and BSE" "image +[0-9]+ x [0-9]+ pixels of 3.00 nm" "SE +[0-9.]+ to"
  WRITES image.exr image.png INFO image.exr "model +secant.json sha256")
semsurf_cli_test(predict.former_names ARGS predict steps.txt --pitch 3nm --z-unit 20nm --channel BSE --model secant.json -q -o image.tif
  WRITES image.tif INFO image.tif "option.scan.height_pitch_nm +3" "option.scan.height_unit_nm +20" "option.output.png_channel +BSE"
  "option.prediction.edge +mirror" "option.prediction.resample +off")
semsurf_cli_test(predict.scene ARGS predict "${PROJECT_SOURCE_DIR}/samples/mesa80.toml" --model secant.json --resample -o mesa.vti
  STDERR "are resampled to" WRITES mesa.vti)
semsurf_cli_test(predict.steep ARGS predict steps.txt --height-pitch 3nm --height-unit 20nm --model secant.json -q -o image.tif
  STDOUT "^$" STDERR "warning: .* steeper than the 70 degrees" WRITES image.tif)
semsurf_cli_test(info.model ARGS info secant.json STDOUT "image model" "for +Si, 1 keV" "warning +few pixels" "all learnt from")

# Registration and reconstruction; tests/cli/reconstruct.py has more.
semsurf_cli_test(help.register ARGS register --help STDOUT "AFM scan" "Registration:" "ambiguous" "Examples:")
semsurf_cli_test(help.reconstruct ARGS reconstruct --help
  STDOUT "Inputs:" "SEM image:" "Registration:" "Reconstruction:" "Output:" "Exit code 4" "Examples:")
semsurf_cli_test(reconstruct.afm_only ARGS reconstruct --afm steps.txt --height-pitch 3nm --level-method none --tip tip.txt
  --height-noise 0.1nm,0.5 --no-picture --threads 1 -o result/ EXIT 4
  STDOUT "-log L AFM" "held by +AFM" "written +result/surface.vti"
  WRITES result/surface.vti result/surface.gsf result/surface.glb result/simulated_afm.vti result/tip.txt result/history.csv result/report.json
  INFO result/surface.vti "option.level.method +none" "option.scan.height_pitch_nm +3" "option.scan.height_noise_nm +0.1,0.5"
  "option.reconstruction.probes +6" "option.reconstruction.optimiser +gauss-newton" "tip +[0-9]+ x [0-9]+ samples, sha256")
semsurf_cli_test(reconstruct.former_names ARGS reconstruct --afm steps.txt --afm-pixel-size 3nm --no-level --tip tip.txt
  --afm-noise 0.5,0.0075 --method lbfgs --tolerance 0.5 --no-picture --threads 1 -q -o result EXIT 4
  WRITES result/surface.gsf INFO result/surface.gsf "option.reconstruction.optimiser +lbfgs"
  "option.reconstruction.optimiser_tolerance +0.5" "option.scan.height_noise_nm +0.1,0.5")

semsurf_cli_test(help.sample ARGS sample --help STDOUT "nist0523-thick" "Examples:" "truth")
semsurf_cli_test(sample.list ARGS sample --list STDOUT "nist0523-thick.*100 nm high" "terrain")
semsurf_cli_test(sample.small ARGS sample islands --size 24x16 --electrons 1 --cache off -o made
  STDOUT "SEM +24 x 16 pixels of 1 primaries" "truth.json"
  WRITES made/afm.gsf made/sem.tif made/truth.gsf made/truth_tip.gsf made/truth_sem.exr made/truth.json
  INFO made/sem.tif "option.sample.electrons +1\n" "option.sample.name +islands\n" "option.sample.seed +1\n" "option.sample.size +24x16\n")
semsurf_cli_test(info.sem_image ARGS info fei.tif
  STDOUT "SEM image, Thermo/FEI, Teneo" "4 x 3 pixels of 7.5" "energy +2 keV" "detector +ETD" "Beam.HV +2000"
  STDERR "note: the databar, the lowest 1 rows, is left out")

# Outputs that may be replaced, and all that is written is named.
semsurf_cli_test(over.before ARGS level block.gsf --level-method none -o plane.gsf STDOUT "written +plane.gsf")
semsurf_cli_test(written.gltf ARGS mesh cube.off -o cube.gltf STDOUT "written +cube.gltf\n +cube.bin" WRITES cube.gltf cube.bin)
semsurf_cli_test(written.tip ARGS tip --shape cone:10nm,15deg --tip-size 5 --height-pitch 2nm -o cone.gsf --plot cone.svg
  STDOUT "written +cone.gsf\n +cone.svg" WRITES cone.gsf cone.svg)

# Units that files state.
semsurf_cli_test(unit.same ARGS mesh two.gltf --unit m -o a.ply WRITES a.ply)
semsurf_cli_test(unit.overridden ARGS mesh two.gltf --unit um --override-unit -o a.ply
  WRITES a.ply INFO a.ply "option.specimen.override_unit +on")
semsurf_cli_test(unit.simulated ARGS simulate two.gltf --unit 2m --override-unit ${few} -o a.exr
  WRITES a.exr INFO a.exr "unit_override.1 +two.gltf, 2")
