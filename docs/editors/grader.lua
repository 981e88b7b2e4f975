-- In ~/.config/nvim/plugin/grader.lua: starts `grader lsp` for the files of robots, in Neovim 0.7 and newer.
if vim.fn.executable("grader") == 0 then
  return
end

local filetypes = { "xml", "yaml", "python", "cpp", "cmake" }
local markers = { "grader.toml", ".git" } -- of the folder that is inspected

vim.api.nvim_create_autocmd({ "BufRead", "BufNewFile" }, {
  pattern = { "*.urdf", "*.xacro", "*.srdf", "*.sdf", "*.world", "*.launch" },
  command = "set filetype=xml",
})
vim.api.nvim_create_autocmd({ "BufRead", "BufNewFile" }, { pattern = "*.rviz", command = "set filetype=yaml" })

if vim.lsp.config then -- Neovim 0.11
  vim.lsp.config("grader", {
    cmd = { "grader", "lsp" },
    filetypes = filetypes,
    root_markers = { markers },
  })
  vim.lsp.enable("grader")
  return
end

local clients = {} -- by their folders

-- Returns the nearest folder above a file that has one of the markers; nil without one.
local function find_root(file)
  local below, folder = nil, vim.fn.fnamemodify(file, ":p:h")
  while folder ~= below do
    for _, marker in ipairs(markers) do
      if vim.fn.getftype(folder .. "/" .. marker) ~= "" then
        return folder
      end
    end
    below, folder = folder, vim.fn.fnamemodify(folder, ":h")
  end
end

local function attach(event)
  local root = find_root(vim.api.nvim_buf_get_name(event.buf))
  local key = root or ""
  if not clients[key] then
    clients[key] = vim.lsp.start_client({
      name = "grader",
      cmd = { "grader", "lsp" },
      root_dir = root,
      workspace_folders = root and { { uri = vim.uri_from_fname(root), name = root } },
      on_exit = function()
        clients[key] = nil
      end,
    })
  end
  vim.lsp.buf_attach_client(event.buf, clients[key])
end

vim.api.nvim_create_autocmd("FileType", { pattern = filetypes, callback = attach })
