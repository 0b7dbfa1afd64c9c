# The modules and what they depend on, on one screen. A module may include a module that it DEPENDS on, and nothing
# else; tools/check_includes.cmake checks every #include against this list. USES names the libraries that a module
# wraps: no other module includes their headers. TESTED_WITH names further modules that its tests may include.
#
#              module     depends on                                             libraries
mansard_module(base                                                             USES TBB::tbb)
mansard_module(geometry DEPENDS base                                            USES GMP::gmpxx GEOS::geos_c)
mansard_module(rays     DEPENDS base geometry                                   USES embree)
mansard_module(solver   DEPENDS base                                            USES CBC::cbc)
mansard_module(model    DEPENDS base geometry)
mansard_module(solid    DEPENDS base geometry model                             USES GMP::gmpxx TESTED_WITH extrude)
mansard_module(crs      DEPENDS base geometry model                             USES GDAL::GDAL)
mansard_module(formats  DEPENDS base geometry model solid crs                   USES GDAL::GDAL tinygltf draco meshoptimizer OpenSSL::Crypto LibXml2::LibXml2 nlohmann_json wabt
                                                                                TESTED_WITH rays ingest extrude label)
mansard_module(cloud    DEPENDS base geometry                                   TESTED_WITH ingest)
mansard_module(ingest   DEPENDS base geometry model crs formats cloud           USES GDAL::GDAL)

mansard_module(texture  DEPENDS base geometry model formats ingest)
mansard_module(block    DEPENDS base geometry model                             TESTED_WITH ingest)
mansard_module(accuracy DEPENDS base geometry rays model                        TESTED_WITH simulate extrude)
mansard_module(vegetation DEPENDS base geometry model)
mansard_module(slice    DEPENDS base geometry block)
mansard_module(sweep    DEPENDS base geometry rays model block slice)
mansard_module(fracture DEPENDS base geometry)
mansard_module(segment  DEPENDS base geometry rays solver block sweep fracture)
mansard_module(profile  DEPENDS base geometry rays model block sweep segment)
mansard_module(extrude  DEPENDS base geometry model solid                       USES GMP::gmpxx Boost::multiprecision)
mansard_module(planes   DEPENDS base geometry                                   USES nanoflann)
mansard_module(refine   DEPENDS base geometry rays model solid extrude planes)
mansard_module(label    DEPENDS base geometry rays model solid                  TESTED_WITH extrude)
mansard_module(evaluate DEPENDS base geometry rays model solid block label      TESTED_WITH ingest extrude)
mansard_module(confidence DEPENDS base geometry rays model solid evaluate      TESTED_WITH extrude)
mansard_module(compare  DEPENDS base geometry rays model)
mansard_module(derive   DEPENDS base geometry rays model crs                    USES GDAL::GDAL TESTED_WITH ingest)
mansard_module(align    DEPENDS base geometry)
mansard_module(roof     DEPENDS base geometry model extrude)
mansard_module(terrain  DEPENDS base geometry model solid)
mansard_module(picture  DEPENDS base geometry rays                              USES PNG::PNG)
mansard_module(report   DEPENDS base geometry rays model accuracy solid formats texture sweep fracture segment refine label evaluate confidence compare picture USES nlohmann_json TESTED_WITH pipeline)
mansard_module(pipeline DEPENDS base geometry rays solver model solid crs formats cloud ingest block accuracy vegetation slice sweep fracture segment profile extrude planes refine label evaluate confidence compare derive align roof terrain picture report texture)
mansard_module(edit     DEPENDS base geometry rays model solid formats ingest extrude refine label evaluate report pipeline USES nlohmann_json)

# Experiments: used by the programs and the tests, not part of what is installed.
mansard_module(simulate IN lab DEPENDS base geometry rays model solid formats ingest extrude label USES nlohmann_json)
mansard_module(explore  IN lab DEPENDS base geometry rays model solid crs formats ingest block fracture segment profile extrude evaluate picture report pipeline USES nlohmann_json)

if(TARGET mansard_formats)
  mansard_laz_decoder(mansard_formats)
endif()

# Results say which version made them.
if(TARGET mansard_pipeline)
  target_compile_definitions(mansard_pipeline PRIVATE MANSARD_VERSION="${PROJECT_VERSION}")
endif()
