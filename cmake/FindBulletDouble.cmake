# Bullet in double precision (pkg-config bullet-float64), whose define must stand in every file that includes Bullet:
# target Bullet::Double.
find_package(PkgConfig REQUIRED)
pkg_check_modules(BULLET_FLOAT64 bullet-float64)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(BulletDouble REQUIRED_VARS BULLET_FLOAT64_LINK_LIBRARIES BULLET_FLOAT64_INCLUDE_DIRS)
if(BulletDouble_FOUND AND NOT TARGET Bullet::Double)
  add_library(Bullet::Double INTERFACE IMPORTED)
  target_include_directories(Bullet::Double SYSTEM INTERFACE ${BULLET_FLOAT64_INCLUDE_DIRS})
  target_compile_definitions(Bullet::Double INTERFACE BT_USE_DOUBLE_PRECISION)
  target_link_libraries(Bullet::Double INTERFACE ${BULLET_FLOAT64_LINK_LIBRARIES})
endif()
