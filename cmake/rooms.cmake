# The doors of the house, on one screen. A room may include a room it DEPENDS on, and nothing else;
# tools/check_doors.cmake holds every #include against this list. USES names the libraries behind that door.
#
#              room       doors                                                        libraries
mansard_room(base                                                             USES TBB::tbb)
mansard_room(geometry DEPENDS base                                            USES GMP::gmpxx GEOS::geos_c)
mansard_room(rays     DEPENDS base geometry                                   USES embree)
mansard_room(solver   DEPENDS base                                            USES CBC::cbc)

mansard_room(ingest   DEPENDS base geometry                                   USES GDAL::GDAL tinygltf draco meshoptimizer OpenSSL::Crypto nlohmann_json)
mansard_room(derive   DEPENDS base geometry rays ingest                        USES GDAL::GDAL)
mansard_room(block    DEPENDS base geometry ingest)
mansard_room(slice    DEPENDS base geometry block)
mansard_room(sweep    DEPENDS base geometry rays block slice)
mansard_room(fracture DEPENDS base geometry)
mansard_room(segment  DEPENDS base geometry rays solver block sweep fracture)
mansard_room(profile  DEPENDS base geometry rays block sweep segment)
mansard_room(extrude  DEPENDS base geometry                                   USES GMP::gmpxx Boost::multiprecision)
mansard_room(refine   DEPENDS base geometry rays extrude)
mansard_room(roof     DEPENDS base geometry ingest extrude)
mansard_room(label    DEPENDS base geometry rays ingest extrude)
mansard_room(evaluate DEPENDS base geometry rays ingest block extrude label)
mansard_room(write    DEPENDS base geometry ingest extrude label              USES nlohmann_json GDAL::GDAL meshoptimizer)
mansard_room(simulate DEPENDS base geometry rays ingest extrude label write   USES nlohmann_json)
mansard_room(picture  DEPENDS base geometry rays                              USES PNG::PNG)
mansard_room(pipeline DEPENDS base geometry rays solver ingest derive block slice sweep fracture segment profile extrude refine roof label evaluate write picture USES nlohmann_json)
mansard_room(edit     DEPENDS base geometry rays ingest extrude label evaluate write pipeline USES nlohmann_json)
mansard_room(explore  DEPENDS base geometry rays ingest block fracture segment profile extrude evaluate write picture pipeline USES nlohmann_json)

# Results say which version made them.
if(TARGET mansard_pipeline)
  target_compile_definitions(mansard_pipeline PRIVATE MANSARD_VERSION="${PROJECT_VERSION}")
endif()
