#include <hdf5.h>

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>
#include <vector>

#include "engine/record/atomic_file.h"
#include "engine/record/hdf5.h"

namespace loopwright {
namespace {

/// An identifier of the library, closed at the end. The library reports a failure by a negative number.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id_ < 0) throw std::runtime_error("the HDF5 library failed (out of memory?)");
  }
  ~Id() { close_(id_); }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void require(herr_t status) {
  if (status < 0) throw std::runtime_error("the HDF5 library failed (out of memory?)");
}

/// UTF-8 of any length.
Id text_type() {
  hid_t type = H5Tcopy(H5T_C_S1);
  if (type >= 0 && (H5Tset_size(type, H5T_VARIABLE) < 0 || H5Tset_cset(type, H5T_CSET_UTF8) < 0)) type = -1;
  return {type, H5Tclose};
}

/// The properties of an object to create, without the time of its creation: equal recordings give
/// equal files.
Id without_times(hid_t kind) {
  const hid_t properties = H5Pcreate(kind);
  if (properties >= 0) require(H5Pset_obj_track_times(properties, 0));
  return {properties, H5Pclose};
}

void write_unit(hid_t dataset, const std::string& unit) {
  const Id type = text_type(), space(H5Screate(H5S_SCALAR), H5Sclose);
  const Id attribute(H5Acreate2(dataset, "unit", type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const char* const text = unit.c_str();
  require(H5Awrite(attribute, type, &text));
}

void write_column(hid_t file, const Column& column) {
  std::string name = column.name;
  std::ranges::replace(name, '/', '|');
  if (name == ".") name = "_";  // the name of the group itself
  const hsize_t rows = column.values.size();
  const Id space(H5Screate_simple(1, &rows, nullptr), H5Sclose), link(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  require(H5Pset_char_encoding(link, H5T_CSET_UTF8));
  const Id creation = without_times(H5P_DATASET_CREATE);
  const Id dataset(H5Dcreate2(file, name.c_str(), H5T_IEEE_F64LE, space, link, creation, H5P_DEFAULT),
                   H5Dclose);
  if (rows > 0)
    require(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, column.values.data()));
  write_unit(dataset, column.unit);
}

void write_facts(hid_t file, const Recording& recording) {
  if (recording.facts.empty()) return;
  std::vector<const char*> texts;
  for (const auto& [key, value] : recording.facts)
    texts.push_back(key.c_str()), texts.push_back(value.c_str());
  const hsize_t size[2] = {recording.facts.size(), 2};
  const Id type = text_type(), space(H5Screate_simple(2, size, nullptr), H5Sclose);
  const Id creation = without_times(H5P_DATASET_CREATE);
  const Id dataset(H5Dcreate2(file, "loopwright_facts", type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                   H5Dclose);
  require(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()));
}

/// The bytes of the file, which the library keeps in memory: it would not detect a full disk.
std::string file_image(const Recording& recording) {
  constexpr size_t growth = 1 << 20;  // [bytes]
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), creation = without_times(H5P_FILE_CREATE);
  require(H5Pset_fapl_core(access, growth, 0));
  require(H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  const Id file(H5Fcreate("recording", H5F_ACC_TRUNC, creation, access), H5Fclose);
  for (const Column& column : recording.columns) write_column(file, column);
  write_facts(file, recording);
  require(H5Fflush(file, H5F_SCOPE_GLOBAL));
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  std::string bytes(size > 0 ? size_t(size) : 0, '\0');
  if (size <= 0 || H5Fget_file_image(file, bytes.data(), bytes.size()) != size)
    throw std::runtime_error("the HDF5 library failed (out of memory?)");
  return bytes;
}

}  // namespace

void write_hdf5(const std::string& path, const Recording& recording) {
  check_recording(recording);
  AtomicFile file(path);  // first, so that an unwritable folder is reported before the work is done
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  std::string bytes;
  try {
    bytes = file_image(recording);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("cannot write \"{}\": {}", path, error.what()));
  }
  file.write(bytes);
  file.commit();
}

}  // namespace loopwright
