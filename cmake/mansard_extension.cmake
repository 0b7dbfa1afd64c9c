# CityJSON files name the extension that declares what is ours in them, and where its schema is: docs/mansard.ext.json,
# installed with the program. Whoever publishes it says where; until then the URL is one of a reserved domain (RFC 6761).
# It is absolute in any case: validators parse it (decision 23).
set(MANSARD_EXTENSION_URL "https://mansard.example/schemas/1.0/mansard.ext.json" CACHE STRING "Where CityJSON files say the schema of their extension is")
if(TARGET mansard_formats)
  target_compile_definitions(mansard_formats PRIVATE MANSARD_EXTENSION_URL="${MANSARD_EXTENSION_URL}")
endif()
set(schema ${PROJECT_SOURCE_DIR}/docs/mansard.ext.json)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${schema})
file(READ ${schema} text)
string(REPLACE "\"url\": \"https://mansard.example/schemas/1.0/mansard.ext.json\"" "\"url\": \"${MANSARD_EXTENSION_URL}\"" text "${text}")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/mansard.ext.json CONTENT "${text}" @ONLY)
if(MANSARD_INSTALL)
  install(FILES ${PROJECT_BINARY_DIR}/mansard.ext.json ${PROJECT_SOURCE_DIR}/docs/plan.schema.json
    DESTINATION ${CMAKE_INSTALL_DATADIR}/mansard COMPONENT program)
endif()
