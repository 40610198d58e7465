#include "simulation/program_mark.h"

#include <elf.h>
#include <link.h>

#include <cstdint>

namespace topple::structure {
namespace {

struct Search {
  std::uintptr_t code;  ///< an address in the object sought
  std::string mark;
};

bool holds(const dl_phdr_info& object, std::uintptr_t code) {
  for (int i = 0; i < object.dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = object.dlpi_phdr[i];
    if (part.p_type != PT_LOAD) continue;
    const std::uintptr_t from = object.dlpi_addr + part.p_vaddr;
    if (code >= from && code < from + part.p_memsz) return true;
  }
  return false;
}

/// Notes lie one after the other, each with its name and its contents filled up to four bytes.
std::string build_id(const char* note, const char* end) {
  const auto filled = [](std::size_t size) { return (size + 3) & ~std::size_t{3}; };
  while (note + sizeof(ElfW(Nhdr)) <= end) {
    const auto& head = *reinterpret_cast<const ElfW(Nhdr)*>(note);
    const char* const name = note + sizeof head;
    const char* const contents = name + filled(head.n_namesz);
    if (head.n_type == NT_GNU_BUILD_ID && std::string(name, head.n_namesz) == std::string("GNU", 4))
      return {contents, head.n_descsz};
    note = contents + filled(head.n_descsz);
  }
  return {};
}

int visit(dl_phdr_info* object, std::size_t, void* data) {
  auto& search = *static_cast<Search*>(data);
  if (!holds(*object, search.code)) return 0;
  for (int i = 0; i < object->dlpi_phnum && search.mark.empty(); ++i) {
    const ElfW(Phdr)& part = object->dlpi_phdr[i];
    if (part.p_type != PT_NOTE) continue;
    const char* const notes = reinterpret_cast<const char*>(object->dlpi_addr + part.p_vaddr);
    search.mark = build_id(notes, notes + part.p_memsz);
  }
  return 1;
}

}  // namespace

std::string program_mark() {
  Search search{reinterpret_cast<std::uintptr_t>(&program_mark), {}};
  dl_iterate_phdr(visit, &search);
  return search.mark;
}

}  // namespace topple::structure
