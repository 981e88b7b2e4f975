-- What somebody does in Neovim, and sees there: makes RESULTS, a file of JSON, in the current folder.
local PATIENCE = 300 * 1000 -- milliseconds after which nothing is expected any more
local CONTROLLERS = "diffdrive_robot/config/controllers.yaml"
local ROBOT = "diffdrive_robot/urdf/diffdrive.urdf.xacro"
local results = {}

local function wait_for(what, condition)
  assert(vim.wait(PATIENCE, condition, 20), what)
end

-- Does something that changes the text of the file that is open.
local function change(what, act)
  local before = vim.api.nvim_buf_get_changedtick(0)
  act()
  wait_for(what, function()
    return vim.api.nvim_buf_get_changedtick(0) > before
  end)
end

local function problems()
  return vim.tbl_map(function(problem)
    return (problem.lnum + 1) .. ": " .. problem.message
  end, vim.diagnostic.get(0))
end

local function screen()
  vim.cmd("redraw!")
  local rows = {}
  for row = 1, vim.o.lines do
    local cells = {}
    for column = 1, vim.o.columns do
      table.insert(cells, vim.fn.screenstring(row, column))
    end
    local text = table.concat(cells):gsub("%s+$", "")
    table.insert(rows, text)
  end
  return rows
end

local function correct_and_rename()
  vim.cmd("edit " .. CONTROLLERS)
  wait_for("problems", function()
    return #vim.diagnostic.get(0) > 0
  end)
  results.problems = problems()
  vim.diagnostic.goto_next({ float = false })
  results.screen = screen()

  vim.ui.select = function(actions, options, choose)
    results.actions = vim.tbl_map(options.format_item, actions)
    choose(actions[1], 1)
  end
  change("the correction", vim.lsp.buf.code_action)
  wait_for("no problems", function()
    return #vim.diagnostic.get(0) == 0
  end)

  vim.cmd("write | edit " .. ROBOT)
  vim.fn.search([[parent link="\zsbase_footprint]])
  change("the new name", function()
    vim.lsp.buf.rename("ground_link")
  end)
  vim.cmd("wall")
end

vim.diagnostic.config({ virtual_text = true })
vim.opt.columns = 120
vim.opt.lines = 16
local is_done, problem = pcall(correct_and_rename)
results.failure = not is_done and problem or nil
vim.fn.writefile({ vim.fn.json_encode(results) }, vim.env.RESULTS)
vim.cmd("qall!")
